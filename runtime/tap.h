// SPDX-License-Identifier: BSD-3-Clause
// Hears chosen channels and hands on the bytes of every sound message; never sends. For programs
// that pass messages on (viewer, relay). What is refused is counted and forgotten.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <lcm/lcm.h>

#include "runtime/message_check.h"

namespace runtime {

/// One sound message, valid during the call only.
struct Heard {
  const ChannelInfo& channel;
  std::int8_t sender;  ///< health_t SERVICE_* on a channel that all share, else 0
  std::span<const std::uint8_t> bytes;
};

class Tap {
 public:
  using Sink = std::function<void(const Heard&)>;

  /// `connection` may be shared. The sink must not throw. Throws BusError where LCM cannot
  /// subscribe.
  Tap(std::shared_ptr<lcm_t> connection, std::span<const ChannelInfo* const> channels, Sink sink);
  ~Tap();
  Tap(const Tap&) = delete;
  Tap& operator=(const Tap&) = delete;

  /// Hands on everything that has arrived; never blocks, and ends after some thousand messages.
  void drain();

  /// Readable when drain() has work to do.
  int file_descriptor() const { return lcm_get_fileno(connection_.get()); }

  std::int64_t received() const { return received_; }
  std::int64_t rejected() const { return rejected_; }

 private:
  struct Input {
    Tap* tap;
    const ChannelInfo* channel;
    lcm_subscription_t* subscription;
  };

  static void on_message(const lcm_recv_buf_t* received, const char* channel, void* input);

  std::shared_ptr<lcm_t> connection_;
  Sink sink_;
  std::vector<std::unique_ptr<Input>> inputs_;
  MessageCheck check_;
  std::int64_t received_ = 0;
  std::int64_t rejected_ = 0;
};

}  // namespace runtime
