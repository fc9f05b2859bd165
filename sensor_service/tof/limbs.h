// SPDX-License-Identifier: BSD-3-Clause
// Where the robot's own limbs are, from its joint angles, as capsules: what a head must not take
// for the world. Only + - * / sqrt, so that the bits are the same on every CPU.
#pragma once

#include <array>

#include <Eigen/Core>

#include "tof/params.h"

namespace tof {

inline constexpr int kNumJoints = 16;  ///< 4 leg + (abduction, hip, knee, jaw); FL, FR, RL, RR

using JointAngles = std::array<double, kNumJoints>;

/// All points within radius_m of the segment; body frame.
struct Capsule {
  Eigen::Vector3d from_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d to_m = Eigen::Vector3d::Zero();
  double radius_m = 0.0;
};

inline constexpr int kCapsulesPerLeg = 6;  ///< thigh, shank, palm, finger, jaw, its tip

using Limbs = std::array<Capsule, 4 * kCapsulesPerLeg>;

/// The radii include params.margin_m.
Limbs limbs_of(const LimbParams& params, const JointAngles& angles_rad);

}  // namespace tof
