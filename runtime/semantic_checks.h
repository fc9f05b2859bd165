// SPDX-License-Identifier: BSD-3-Clause
// Whether the values of a decoded message mean what its .lcm file documents: finite, in range,
// known enumerators, indices that exist, orders kept, counts that agree. Each returns kNone or
// kValue, allocates nothing and is linear in the size of the message.
//
// Not here: anything that needs an earlier message of the stream (gaps, staleness).
#pragma once

#include "runtime/reject.h"

namespace ladder_msgs {
class climb_state_t;
class command_t;
class config_t;
class event_t;
class health_t;
class imu_t;
class ladder_t;
class point_cloud_t;
class pose_t;
class tof_frame_t;
class topology_t;
class truth_t;
}  // namespace ladder_msgs

namespace runtime {

Reject check_values(const ladder_msgs::climb_state_t& message);
Reject check_values(const ladder_msgs::command_t& message);
Reject check_values(const ladder_msgs::config_t& message);
Reject check_values(const ladder_msgs::event_t& message);
Reject check_values(const ladder_msgs::health_t& message);
Reject check_values(const ladder_msgs::imu_t& message);
Reject check_values(const ladder_msgs::ladder_t& message);
Reject check_values(const ladder_msgs::point_cloud_t& message);
Reject check_values(const ladder_msgs::pose_t& message);
Reject check_values(const ladder_msgs::tof_frame_t& message);
Reject check_values(const ladder_msgs::topology_t& message);
Reject check_values(const ladder_msgs::truth_t& message);

}  // namespace runtime
