// SPDX-License-Identifier: BSD-3-Clause
// The four legs and what is counted per leg. Body frame: x to the head, y left, z out of the back.
#pragma once

#include <array>

#include <Eigen/Core>

namespace climb {

/// Also the index into every per-leg array and the leg's number on the bus.
enum Leg : int { kFrontLeft = 0, kFrontRight = 1, kRearLeft = 2, kRearRight = 3 };

inline constexpr int kNumLegs = 4;
inline constexpr int kNumLegJoints = 3;  ///< abduction about x, hip and knee about y
inline constexpr std::array<Leg, kNumLegs> kLegs = {kFrontLeft, kFrontRight, kRearLeft, kRearRight};

template <typename T>
using PerLeg = std::array<T, kNumLegs>;

/// Abduction, hip, knee [rad]; the claw's jaw is joint 4 of the leg and moves no foot.
using LegAngles = Eigen::Vector3d;

constexpr bool is_front(Leg leg) {
  return leg == kFrontLeft || leg == kFrontRight;
}
constexpr bool is_left(Leg leg) {
  return leg == kFrontLeft || leg == kRearLeft;
}
/// +1 at the front, -1 at the rear.
constexpr double lengthwise_sign(Leg leg) {
  return is_front(leg) ? 1.0 : -1.0;
}
/// +1 on the left, -1 on the right.
constexpr double lateral_sign(Leg leg) {
  return is_left(leg) ? 1.0 : -1.0;
}

/// The other one of its pair.
constexpr Leg mate_of(Leg leg) {
  return static_cast<Leg>(leg ^ 1);
}

constexpr const char* name(Leg leg) {
  constexpr std::array<const char*, kNumLegs> kNames = {"FL", "FR", "RL", "RR"};
  return kNames[static_cast<std::size_t>(leg)];
}

}  // namespace climb
