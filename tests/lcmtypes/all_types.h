// SPDX-License-Identifier: BSD-3-Clause
// Every message type, as a list that templates can go over. A new type is added here; the count is
// compared with the generated tables.
#pragma once

#include <cstdint>
#include <tuple>
#include <type_traits>
#include <vector>

#include "ladder_msgs/encode_guard.hpp"
#include "ladder_msgs/wire_tables.hpp"

namespace lcmtypes {

using AllMessages =
    std::tuple<ladder_msgs::climb_state_t, ladder_msgs::command_t, ladder_msgs::config_t,
               ladder_msgs::event_t, ladder_msgs::health_t, ladder_msgs::imu_t,
               ladder_msgs::ladder_t, ladder_msgs::point_cloud_t, ladder_msgs::pose_t,
               ladder_msgs::tof_frame_t, ladder_msgs::topology_t, ladder_msgs::truth_t>;
inline constexpr std::size_t kNumTypes = std::tuple_size_v<AllMessages>;
static_assert(kNumTypes == std::size(runtime::kWireTypes), "a type is missing in AllMessages");

/// Calls visit(std::type_identity<Msg>{}) for each type in turn.
template <class Visit>
void for_each_message_type(Visit visit) {
  [&]<class... Msg>(std::type_identity<std::tuple<Msg...>>) {
    (visit(std::type_identity<Msg>{}), ...);
  }(std::type_identity<AllMessages>{});
}

/// The bytes that lcm would carry. Unlike publish() it returns what was written, not an error code.
template <class Msg>
std::vector<std::uint8_t> encode(const Msg& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  const int written = message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  bytes.resize(written < 0 ? 0 : static_cast<std::size_t>(written));
  return bytes;
}

}  // namespace lcmtypes
