// SPDX-License-Identifier: BSD-3-Clause
// The plant's own legs: forward kinematics and Jacobian, and an iterative inverse for start poses.
// Independent of the controller's analytic solution, on purpose. Body frame: x to the head, y left,
// z out of the back. The foot is the point that lies on the axis of a held rung.
#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

namespace simulator {

inline constexpr int kNumLegs = 4;       ///< FL, FR, RL, RR
inline constexpr int kJointsPerLeg = 4;  ///< abduction, hip, knee, jaw
inline constexpr int kNumAxes = kNumLegs * kJointsPerLeg;
inline constexpr std::array<const char*, kNumLegs> kLegNames = {"FL", "FR", "RL", "RR"};

constexpr int axis_of(int leg, int joint) {
  return kJointsPerLeg * leg + joint;
}
constexpr int leg_of(int axis) {
  return axis / kJointsPerLeg;
}
constexpr int joint_of(int axis) {
  return axis % kJointsPerLeg;
}
constexpr bool is_jaw(int axis) {
  return joint_of(axis) == 3;
}
constexpr double forward_sign(int leg) {
  return leg < 2 ? 1.0 : -1.0;
}
constexpr double left_sign(int leg) {
  return leg % 2 == 0 ? 1.0 : -1.0;
}

struct RobotGeometry {
  double hip_x_m = 0.25;  ///< abduction axis from the body's origin
  double hip_y_m = 0.10;
  double abduction_m = 0.05;  ///< from there sideways to the hip
  double thigh_m = 0.22;
  double shank_m = 0.24;  ///< knee to foot
};

using LegAngles = Eigen::Vector3d;

Eigen::Vector3d foot_in_body(const RobotGeometry& geometry, int leg, const LegAngles& angles);
/// d foot / d angles [m/rad].
Eigen::Matrix3d foot_jacobian(const RobotGeometry& geometry, int leg, const LegAngles& angles);
/// Angles that put the foot there, on the leg's knee branch (front knees bend up, rear ones down);
/// none when out of reach. Damped Newton steps: for starting poses, not for a control loop.
std::optional<LegAngles> angles_for_foot(const RobotGeometry& geometry, int leg,
                                         const Eigen::Vector3d& foot_m);

}  // namespace simulator
