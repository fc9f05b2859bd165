// SPDX-License-Identifier: BSD-3-Clause
// The one door to LCM: guarded raw subscriptions into mailboxes and queues, and typed publishing.
// One thread owns it. Handlers never throw: a malformed message is counted by cause and forgotten.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <lcm/lcm.h>

#include "base/check.h"
#include "runtime/channels.h"
#include "runtime/mailbox.h"
#include "runtime/wire_guard.h"

namespace runtime {

/// LCM cannot be used as asked: what, and the exact fix. Exit code 3.
struct BusError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Stream-level judgement of seq and utime, the same for every channel with one sender.
struct StreamPosition {
  std::int64_t utime = 0;
  std::int64_t seq = -1;
};

/// Compares a message with the one before it: updates position and counts, kStale for a duplicate
/// or a late one. A jump backwards by more than a second is a new recording or a restarted sender
/// and is accepted (counts.restarts).
Reject judge_order(StreamPosition next, StreamPosition& position, InputCounts& counts);

class Bus {
 public:
  static constexpr const char* kDefaultUrl =
      "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304";

  /// Opens its own connection. Throws BusError where there is no route for multicast.
  explicit Bus(const std::string& url);
  /// Shares a connection, e.g. memq:// between the services of one process.
  explicit Bus(std::shared_ptr<lcm_t> connection);
  ~Bus();
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  struct Input {
    const char* channel_name = nullptr;
    std::int16_t channel_number = 0;
    InputCounts counts;
    StreamPosition position;
    std::function<Reject(std::span<const std::uint8_t>, Input&)> accept;
    Bus* bus = nullptr;
  };

  /// The newest message of a stream. The mailbox lives as long as the bus.
  template <class Msg>
  Mailbox<Msg>& newest(const Channel<Msg>& channel) {
    return subscribe<Msg, Mailbox<Msg>>(channel, true);
  }

  /// Every message in order, up to capacity waiting at a time.
  template <class Msg>
  Queue<Msg>& queue(const Channel<Msg>& channel, std::size_t capacity) {
    return subscribe<Msg, Queue<Msg>>(channel, true, capacity);
  }

  /// As queue(), for channels that several senders share (HEALTH, EVENT, CONFIG): the order of seq
  /// is not judged.
  template <class Msg>
  Queue<Msg>& shared_queue(const Channel<Msg>& channel, std::size_t capacity) {
    return subscribe<Msg, Queue<Msg>>(channel, false, capacity);
  }

  /// Encodes and sends. A message whose counts disagree with its arrays is our own bug (CHECK). A
  /// failed send is counted.
  template <class Msg>
  void publish(const Channel<Msg>& channel, const Msg& message) {
    CHECK(encodable(message),
          "message counts must equal the sizes of their arrays and stay within their maxima");
    buffer_.resize(static_cast<std::size_t>(message.getEncodedSize()));
    message.encode(buffer_.data(), 0, static_cast<int>(buffer_.size()));
    send(channel.name);
  }

  /// Hands everything that has arrived to the mailboxes; returns the number of messages. Never
  /// blocks.
  int drain();

  /// Readable when drain() has work to do.
  int file_descriptor() const { return lcm_get_fileno(connection_.get()); }

  const std::vector<std::unique_ptr<Input>>& inputs() const { return inputs_; }
  std::int64_t rejected(Reject cause) const { return rejected_[static_cast<std::size_t>(cause)]; }
  std::int64_t publish_failures() const { return publish_failures_; }

 private:
  template <class Msg, class Holder, class... Args>
  Holder& subscribe(const Channel<Msg>& channel, bool judge, Args... args) {
    auto input = std::make_unique<Input>();
    auto holder = std::make_shared<Holder>(input->counts, args...);
    input->channel_name = channel.name;
    input->channel_number = channel.number;
    input->bus = this;
    input->accept = [holder, judge, message = Msg{}](std::span<const std::uint8_t> bytes,
                                                     Input& in) mutable {
      Reject verdict = decode_guarded(bytes, message);
      if (verdict == Reject::kNone && judge) {
        verdict = judge_order({message.utime, message.seq}, in.position, in.counts);
      }
      if (verdict == Reject::kNone) holder->put(message);
      return verdict;
    };
    attach(*input);
    inputs_.push_back(std::move(input));
    return *holder;
  }

  void attach(Input& input);
  void send(const char* channel_name);
  static void on_message(const lcm_recv_buf_t* received, const char* channel, void* input);

  std::shared_ptr<lcm_t> connection_;
  std::vector<std::unique_ptr<Input>> inputs_;
  std::vector<lcm_subscription_t*> subscriptions_;
  std::array<std::int64_t, kNumRejects> rejected_{};
  std::vector<std::uint8_t> buffer_;
  std::int64_t publish_failures_ = 0;
};

/// Opens a connection; throws BusError with the exact fix.
std::shared_ptr<lcm_t> open_lcm(const std::string& url);

/// "" or what is wrong with the kernel's socket buffers for this URL and how to mend it.
std::string socket_buffer_problem(const std::string& url);

}  // namespace runtime
