// SPDX-License-Identifier: BSD-3-Clause
#include "runtime/bus.h"

#include <algorithm>
#include <charconv>
#include <fstream>

namespace runtime {
namespace {

constexpr std::int64_t kNewRecordingUs = 1'000'000;
constexpr int kMaxMessagesPerDrain = 4096;  // a flood must not keep the work step from running
constexpr int kQueueCapacity = 512;  // LCM drops the newest beyond this; drained far more often

/// The value of "name=123" in an LCM URL, 0 where absent.
std::int64_t url_number(const std::string& url, const std::string& name) {
  const std::size_t at = url.find(name + "=");
  std::int64_t value = 0;
  if (at != std::string::npos)
    std::from_chars(url.data() + at + name.size() + 1, url.data() + url.size(), value);
  return value;
}

std::int64_t kernel_number(const std::string& path) {
  std::ifstream stream(path);
  std::int64_t value = 0;
  stream >> value;
  return value;
}

}  // namespace

std::shared_ptr<lcm_t> open_lcm(const std::string& url) {
  lcm_t* connection = lcm_create(url.c_str());
  if (connection == nullptr) {
    std::string fix = "check the URL";
    if (url.starts_with("udpm")) {
      fix =
          "most likely there is no route for multicast; on the robot and on a machine without a "
          "network run\n"
          "    sudo ip link set lo up && sudo ip route replace 239.255.76.67/32 dev lo src "
          "127.0.0.1";
    }
    throw BusError("LCM cannot open " + url + ": " + fix);
  }
  return {connection, lcm_destroy};
}

std::string socket_buffer_problem(const std::string& url) {
  if (!url.starts_with("udpm")) return "";
  constexpr std::int64_t kNeeded = 4'194'304;
  const std::int64_t asked = url_number(url, "recv_buf_size");
  const std::int64_t allowed = kernel_number("/proc/sys/net/core/rmem_max");
  const std::int64_t stock = kernel_number("/proc/sys/net/core/rmem_default");
  const std::int64_t granted = asked > 0 ? std::min(asked, allowed) : stock;
  if (granted >= kNeeded) return "";
  return "the socket receive buffer is " + std::to_string(granted) + " bytes, " +
         std::to_string(kNeeded) +
         " are needed: point clouds will be lost. Run\n    sudo sysctl -w "
         "net.core.rmem_max=8388608 "
         "net.core.rmem_default=4194304\nand use the URL " +
         Bus::kDefaultUrl;
}

Reject judge_order(StreamPosition next, StreamPosition& position, InputCounts& counts) {
  const bool first = position.seq < 0;
  if (first || next.utime < position.utime - kNewRecordingUs ||
      (next.seq < position.seq && next.utime > position.utime)) {
    counts.restarts += first ? 0 : 1;
    position = next;
    return Reject::kNone;
  }
  if (next.seq <= position.seq || next.utime < position.utime) return Reject::kStale;
  counts.lost += next.seq - position.seq - 1;
  position = next;
  return Reject::kNone;
}

Bus::Bus(const std::string& url) : Bus(open_lcm(url)) {}

Bus::Bus(std::shared_ptr<lcm_t> connection) : connection_(std::move(connection)) {}

Bus::~Bus() {
  for (lcm_subscription_t* subscription : subscriptions_)
    lcm_unsubscribe(connection_.get(), subscription);
}

void Bus::attach(Input& input) {
  lcm_subscription_t* subscription =
      lcm_subscribe(connection_.get(), input.channel_name, &Bus::on_message, &input);
  if (subscription == nullptr) {
    throw BusError(
        "LCM sends but does not hear itself: a firewall or an address filter drops multicast, or "
        "its route has another source address than lo's; run ladder-doctor --only route");
  }
  lcm_subscription_set_queue_capacity(subscription, kQueueCapacity);
  subscriptions_.push_back(subscription);
}

void Bus::on_message(const lcm_recv_buf_t* received, const char* /*channel*/, void* user) {
  Input& input = *static_cast<Input*>(user);
  ++input.counts.received;
  const auto* bytes = static_cast<const std::uint8_t*>(received->data);
  const Reject verdict = input.accept({bytes, received->data_size}, input);
  if (verdict == Reject::kNone) return;
  ++input.counts.rejected;
  ++input.bus->rejected_[static_cast<std::size_t>(verdict)];
}

void Bus::send(const char* channel_name) {
  const int sent = lcm_publish(connection_.get(), channel_name, buffer_.data(),
                               static_cast<unsigned int>(buffer_.size()));
  if (sent != 0) ++publish_failures_;
}

int Bus::drain() {
  int handled = 0;
  while (handled < kMaxMessagesPerDrain && lcm_handle_timeout(connection_.get(), 0) > 0) ++handled;
  return handled;
}

}  // namespace runtime
