// SPDX-License-Identifier: BSD-3-Clause
// LCM at one end of the relay: messages heard there for the other end, and messages of the other
// end that are published there. Which channels go which way each end decides for itself.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <lcm/lcm.h>

#include "runtime/message_board.h"
#include "runtime/message_check.h"
#include "runtime/tap.h"

namespace relay {

using Channels = std::vector<const runtime::ChannelInfo*>;

/// Channels of a comma separated list of names; "" is none. Throws std::runtime_error for a name
/// that is no channel.
Channels channels_of(std::string_view names);

/// What an operator's station wants to see, but for depth images and clouds.
inline constexpr const char* kTelemetry =
    "LADDER_TOPOLOGY,LADDER_RUNGS,LADDER_POSE,LADDER_CLIMB,LADDER_HEALTH,LADDER_EVENT,LADDER_"
    "CONFIG,"
    "LADDER_TRUTH";

class Endpoint {
 public:
  /// Throws std::runtime_error where a channel would go both ways, and so round for ever.
  Endpoint(std::shared_ptr<lcm_t> connection, const Channels& send, Channels receive);

  /// Puts what was heard on LCM onto the board.
  void drain() { tap_.drain(); }
  int file_descriptor() const { return tap_.file_descriptor(); }

  /// For the connections: each reads at its own pace.
  const runtime::MessageBoard& board() const { return board_; }

  /// The channel that the other end may fill by this number, or nullptr.
  const runtime::ChannelInfo* find_received(std::int16_t number) const;

  /// Publishes a message of the other end, if a service would accept it.
  void publish(const runtime::ChannelInfo& channel, std::span<const std::uint8_t> message);

  std::int64_t num_published() const { return num_published_; }
  std::int64_t num_rejected() const { return num_rejected_; }

 private:
  std::shared_ptr<lcm_t> connection_;
  Channels receive_;
  runtime::MessageBoard board_;
  runtime::Tap tap_;
  runtime::MessageCheck check_;
  std::int64_t num_published_ = 0;
  std::int64_t num_rejected_ = 0;
};

}  // namespace relay
