// SPDX-License-Identifier: BSD-3-Clause
#include "runtime/tap.h"

#include "runtime/bus.h"

namespace runtime {
namespace {

constexpr int kMaxMessagesPerDrain = 4096;  // a flood must not keep the caller from its other work
constexpr int kQueueCapacity = 128;

}  // namespace

Tap::Tap(std::shared_ptr<lcm_t> connection, std::span<const ChannelInfo* const> channels, Sink sink)
    : connection_(std::move(connection)), sink_(std::move(sink)) {
  for (const ChannelInfo* channel : channels) {
    auto input = std::make_unique<Input>(Input{this, channel, nullptr});
    input->subscription = lcm_subscribe(connection_.get(), std::string(channel->name).c_str(),
                                        &Tap::on_message, input.get());
    if (input->subscription == nullptr) {
      throw BusError(
          "LCM does not hear itself: a firewall or an address filter drops multicast; run "
          "ladder-doctor --only route");
    }
    lcm_subscription_set_queue_capacity(input->subscription, kQueueCapacity);
    inputs_.push_back(std::move(input));
  }
}

Tap::~Tap() {
  for (const auto& input : inputs_) lcm_unsubscribe(connection_.get(), input->subscription);
}

void Tap::drain() {
  int handled = 0;
  while (handled < kMaxMessagesPerDrain && lcm_handle_timeout(connection_.get(), 0) > 0) ++handled;
}

void Tap::on_message(const lcm_recv_buf_t* received, const char* /*channel*/, void* user) {
  const Input& input = *static_cast<Input*>(user);
  Tap& tap = *input.tap;
  ++tap.received_;
  const std::span bytes(static_cast<const std::uint8_t*>(received->data), received->data_size);
  if (tap.check_.check(bytes, *input.channel) != Reject::kNone) {
    ++tap.rejected_;
    return;
  }
  tap.sink_({*input.channel, tap.check_.sender(), bytes});
}

}  // namespace runtime
