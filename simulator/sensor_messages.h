// SPDX-License-Identifier: BSD-3-Clause
// What heads and scene are, as messages: the same for the robot that stands still and for the one
// that climbs.
#pragma once

#include <cstdint>

#include <Eigen/Geometry>

#include "ladder_msgs/tof_frame_t.hpp"
#include "ladder_msgs/truth_t.hpp"
#include "simulator/head_renderer.h"
#include "simulator/scene.h"
#include "simulator/visibility.h"

namespace simulator {

/// One image of a head. Time, number and head index are the caller's.
ladder_msgs::tof_frame_t frame_message(const HeadRenderer& head, const SensorParams& sensor,
                                       const HeadImage& image);

/// The scene in odom, where the body is, and what the heads saw of each rung. Time and number are
/// the caller's.
ladder_msgs::truth_t scene_truth(const Scene& scene, const RungVisibility& seen,
                                 const Eigen::Isometry3d& T_odom_world,
                                 const Eigen::Isometry3d& T_world_body);

}  // namespace simulator
