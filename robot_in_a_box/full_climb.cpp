// SPDX-License-Identifier: BSD-3-Clause
#include "robot_in_a_box/full_climb.h"

#include "climb_controller/config.h"

namespace robot_in_a_box {
namespace {

PhysicalClimbParams climb_params(const FullClimbParams& params, const runtime::Config& config) {
  PhysicalClimbParams climb = params.climb;
  climb.cycle = climb_controller::read_params(config.table("climb")).cycle;
  climb.attitude_from_samples = true;
  return climb;
}

FullPerceptionParams perception_params(const FullClimbParams& params,
                                       const runtime::Config& config) {
  FullPerceptionParams perception = params.perception;
  perception.memory = climb_controller::read_params(config.table("climb")).memory;
  return perception;
}

/// Odom begins where the body is in the dock; its axes are the world's.
Eigen::Isometry3d T_odom_world(const PhysicalClimb& climb) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = -climb.box().plant().T_world_body().translation();
  return pose;
}

}  // namespace

FullClimb::FullClimb(const FullClimbParams& params, const runtime::Config& config)
    : climb_(climb_params(params, config)),
      eyes_(perception_params(params, config), config, climb_.scene(), climb_.model(),
            T_odom_world(climb_)) {
  climb_.box().see_with(eyes_);
}

}  // namespace robot_in_a_box
