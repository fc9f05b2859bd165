// SPDX-License-Identifier: BSD-3-Clause
// The channels: name, number in health_t, and the message type. A channel that no service uses yet
// (LADDER_SIM) enters together with its type.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "ladder_msgs/health_t.hpp"
#include "ladder_msgs/wire_tables.hpp"
#include "runtime/wire_type.h"

namespace runtime {

/// A channel that carries messages of type Msg.
template <class Msg>
struct Channel {
  const char* name;
  std::int16_t number;  ///< health_t CHANNEL_*
};

namespace channels {

using Health = ladder_msgs::health_t;

inline constexpr std::array<Channel<ladder_msgs::tof_frame_t>, 4> kTof{{
    {"LADDER_TOF_0", Health::CHANNEL_TOF_0},
    {"LADDER_TOF_1", Health::CHANNEL_TOF_1},
    {"LADDER_TOF_2", Health::CHANNEL_TOF_2},
    {"LADDER_TOF_3", Health::CHANNEL_TOF_3},
}};
inline constexpr Channel<ladder_msgs::imu_t> kImu{"LADDER_IMU", Health::CHANNEL_IMU};
inline constexpr Channel<ladder_msgs::pose_t> kPose{"LADDER_POSE", Health::CHANNEL_POSE};
inline constexpr Channel<ladder_msgs::point_cloud_t> kCloud{"LADDER_CLOUD", Health::CHANNEL_CLOUD};
inline constexpr Channel<ladder_msgs::topology_t> kTopology{"LADDER_TOPOLOGY",
                                                            Health::CHANNEL_TOPOLOGY};
inline constexpr Channel<ladder_msgs::ladder_t> kRungs{"LADDER_RUNGS", Health::CHANNEL_RUNGS};
inline constexpr Channel<ladder_msgs::command_t> kCommand{"LADDER_COMMAND",
                                                          Health::CHANNEL_COMMAND};
inline constexpr Channel<ladder_msgs::climb_state_t> kClimb{"LADDER_CLIMB", Health::CHANNEL_CLIMB};
inline constexpr Channel<ladder_msgs::health_t> kHealth{"LADDER_HEALTH", Health::CHANNEL_HEALTH};
inline constexpr Channel<ladder_msgs::event_t> kEvent{"LADDER_EVENT", Health::CHANNEL_EVENT};
inline constexpr Channel<ladder_msgs::config_t> kConfig{"LADDER_CONFIG", Health::CHANNEL_CONFIG};
inline constexpr Channel<ladder_msgs::truth_t> kTruth{"LADDER_TRUTH", Health::CHANNEL_TRUTH};

}  // namespace channels

/// A channel without its C++ type: for tools that meet any of them (replay, log tools, spies).
struct ChannelInfo {
  std::string_view name;
  std::int16_t number;
  const WireType* type;
};

template <class Msg>
constexpr ChannelInfo info(const Channel<Msg>& channel) {
  return {channel.name, channel.number, &kWireTypeOf<Msg>};
}

inline constexpr std::array kChannels{
    info(channels::kTof[0]),  info(channels::kTof[1]),   info(channels::kTof[2]),
    info(channels::kTof[3]),  info(channels::kImu),      info(channels::kPose),
    info(channels::kCloud),   info(channels::kTopology), info(channels::kRungs),
    info(channels::kCommand), info(channels::kClimb),    info(channels::kHealth),
    info(channels::kEvent),   info(channels::kConfig),   info(channels::kTruth),
};

/// The channel of this name, or nullptr.
constexpr const ChannelInfo* find_channel(std::string_view name) {
  for (const ChannelInfo& channel : kChannels) {
    if (channel.name == name) return &channel;
  }
  return nullptr;
}

}  // namespace runtime
