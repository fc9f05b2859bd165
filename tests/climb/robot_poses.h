// SPDX-License-Identifier: BSD-3-Clause
// Poses and stances of the climbing robot that several tests use.
#pragma once

#include <cmath>
#include <limits>

#include <Eigen/Dense>

#include "base/rng.h"
#include "climb/leg_kinematics.h"
#include "climb/support.h"

namespace climb_tests {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

inline double between(base::Rng& rng, double low, double high) {
  return low + (high - low) * rng.uniform();
}

inline Eigen::Vector3d in_box(base::Rng& rng, double half) {
  const double x = between(rng, -half, half);
  const double y = between(rng, -half, half);
  return {x, y, between(rng, -half, half)};
}

/// Uniform within the joint limits.
inline climb::LegAngles random_angles(base::Rng& rng, const climb::LegKinematics& kinematics,
                                      climb::Leg leg) {
  climb::LegAngles angles;
  for (int joint = 0; joint < climb::kNumLegJoints; ++joint) {
    const climb::JointLimits& limits = kinematics.limits(leg, joint);
    angles[joint] = between(rng, limits.min_rad, limits.max_rad);
  }
  return angles;
}

/// Depth of a foot below its hip in the leg's plane: z before the abduction turns it.
inline double depth_m(const climb::RobotParams& robot, const climb::LegAngles& q) {
  return robot.thigh_m * std::cos(q[1]) + robot.shank_m * std::cos(q[1] + q[2]);
}

/// A pose that inverse() must find: within the limits, foot on the ladder's side.
inline climb::LegAngles random_pose(base::Rng& rng, const climb::RobotParams& robot,
                                    const climb::LegKinematics& kinematics, climb::Leg leg) {
  while (true) {
    const climb::LegAngles q = random_angles(rng, kinematics, leg);
    if (depth_m(robot, q) >= 1.01 * robot.min_height_m) return q;
  }
}

/// The robot on the ladder: body frame along the ladder, feet at x = `along_m` each, y = +-0.15,
/// in the ladder's plane at z = -stand_off; rung ids are given.
inline climb::Stance stance_at(const climb::ClimbParams& params,
                               const climb::PerLeg<double>& along_m,
                               const climb::PerLeg<int>& rung_ids) {
  const climb::LegKinematics kinematics(params.robot);
  climb::Stance stance;
  for (const climb::Leg leg : climb::kLegs) {
    const Eigen::Vector3d foot(along_m[leg],
                               climb::lateral_sign(leg) * params.motion.lateral_home_m,
                               -params.motion.stand_off_m);
    stance.angles_rad[leg] = kinematics.inverse(leg, foot).angles_rad;
    stance.contacts[leg].weight = 1.0;
    stance.contacts[leg].rung_id = rung_ids[leg];
  }
  return stance;
}

/// Fronts one rung above the body's middle, rears one below; rungs 0.30 m apart.
inline climb::Stance hanging_stance(const climb::ClimbParams& params) {
  return stance_at(params, {0.3, 0.3, -0.3, -0.3}, {3, 3, 1, 1});
}

}  // namespace climb_tests
