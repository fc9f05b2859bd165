// SPDX-License-Identifier: BSD-3-Clause
// Between messages and the library's structures: no arithmetic beyond copying.
#pragma once

#include <optional>

#include "ladder_msgs/climb_state_t.hpp"
#include "ladder_msgs/imu_t.hpp"
#include "ladder_msgs/point_cloud_t.hpp"
#include "ladder_msgs/pose_t.hpp"
#include "ladder_msgs/tof_frame_t.hpp"
#include "tof/cloud.h"
#include "tof/depth_frame.h"
#include "tof/gravity.h"
#include "tof/limbs.h"
#include "tof/pose.h"

namespace sensor_service {

/// The frame's pixels are the message's.
tof::DepthFrame to_depth_frame(const ladder_msgs::tof_frame_t& message);
tof::ImuSample to_imu_sample(const ladder_msgs::imu_t& message);
tof::Pose to_pose(const ladder_msgs::pose_t& message);
/// None while a drive has not told its position.
std::optional<tof::JointAngles> to_joints(const ladder_msgs::climb_state_t& message);

void to_message(const tof::DepthFrame& frame, ladder_msgs::tof_frame_t& message);
/// Fills everything but seq.
void to_message(const tof::ImuSample& sample, ladder_msgs::imu_t& message);
/// Fills everything but seq.
void to_message(const tof::Cloud& cloud, ladder_msgs::point_cloud_t& message);

}  // namespace sensor_service
