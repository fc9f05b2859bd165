// SPDX-License-Identifier: BSD-3-Clause
// A leg between its three joint angles and its foot: forward, analytic inverse, Jacobian, claw.
// All in the body frame. "Foot" is the point that lies on the axis of a held rung.
// The foot is always on the ladder's side of the hip (z < 0 there), the knee on the leg's branch.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "climb/params.h"

namespace climb {

enum class Reach : std::uint8_t {
  kReachable,
  kNotFinite,
  kTooFar,     ///< beyond the straight leg
  kTooNear,    ///< within the folded leg
  kAtHipAxis,  ///< nearer than min_height_m to the hip, or between hip and abduction axis
  kAbductionLimit,
  kHipLimit,
  kKneeLimit
};

const char* name(Reach reach);

struct LegSolution {
  Reach reach = Reach::kNotFinite;
  LegAngles angles_rad = LegAngles::Zero();  ///< within the limits, or zero when not reachable
  bool reachable() const { return reach == Reach::kReachable; }
};

class LegKinematics {
 public:
  explicit LegKinematics(const RobotParams& robot);

  Eigen::Vector3d foot_m(Leg leg, const LegAngles& angles_rad) const;

  /// Exact to rounding; at most one solution, as knee branch and side are given.
  LegSolution inverse(Leg leg, const Eigen::Vector3d& foot_m) const;

  /// d foot / d angles [m/rad].
  Eigen::Matrix3d jacobian(Leg leg, const LegAngles& angles_rad) const;

  /// Claw axes as columns: x towards the palm's edge, y along a held rung, z out of the ladder.
  Eigen::Matrix3d R_body_claw(Leg leg, const LegAngles& angles_rad) const;

  /// The axis of a rung on which the claw has settled. It stays there when the shank turns; the
  /// foot's point, some mm beside it, does not.
  Eigen::Vector3d seat_m(Leg leg, const LegAngles& angles_rad) const;

  /// Unit: the way a claw leaves its rung without dragging at it (the claw's z).
  Eigen::Vector3d retract_direction(Leg leg, const LegAngles& angles_rad) const;

  /// Distance to the nearest joint limit; negative outside, NaN for NaN.
  double limit_margin_rad(Leg leg, const LegAngles& angles_rad) const;

  /// The nearest angles within the limits (NaN stays NaN).
  LegAngles clamped(Leg leg, const LegAngles& angles_rad) const;

  /// Limits of one joint of one leg, with the knee's sign applied.
  const JointLimits& limits(Leg leg, int joint) const { return limits_[leg][joint]; }

  Eigen::Vector3d hip_m(Leg leg) const;

 private:
  RobotParams robot_;
  PerLeg<std::array<JointLimits, kNumLegJoints>> limits_;
};

/// Smallest singular value of a Jacobian [m/rad]: foot speed per joint speed in the worst
/// direction.
double smallest_singular_value(const Eigen::Matrix3d& jacobian);

}  // namespace climb
