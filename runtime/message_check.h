// SPDX-License-Identifier: BSD-3-Clause
// The guard for programs that pass messages on without using them (viewer, relay): the bytes of any
// of our types are walked, decoded and their values checked, as a service would.
#pragma once

#include <cstdint>
#include <span>
#include <tuple>

#include "runtime/channels.h"
#include "runtime/wire_guard.h"

namespace runtime {

class MessageCheck {
 public:
  /// kNone, or why no service would use this message. Reuses its memory from call to call.
  Reject check(std::span<const std::uint8_t> message, const ChannelInfo& channel);

  /// Who sent the message that check() has just accepted: its `service` (health_t SERVICE_*) on a
  /// channel that all share, else 0.
  std::int8_t sender() const { return sender_; }

 private:
  std::tuple<ladder_msgs::climb_state_t, ladder_msgs::command_t, ladder_msgs::config_t,
             ladder_msgs::event_t, ladder_msgs::health_t, ladder_msgs::imu_t, ladder_msgs::ladder_t,
             ladder_msgs::point_cloud_t, ladder_msgs::pose_t, ladder_msgs::tof_frame_t,
             ladder_msgs::topology_t, ladder_msgs::truth_t>
      decoded_;
  std::int8_t sender_ = 0;
};

}  // namespace runtime
