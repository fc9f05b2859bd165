// SPDX-License-Identifier: BSD-3-Clause
#include "climb/leg_kinematics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

namespace climb {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Into -pi..pi.
double wrapped(double angle_rad) {
  return std::remainder(angle_rad, 2.0 * kPi);
}

bool within(const JointLimits& limits, double angle_rad) {  // false for NaN
  return angle_rad >= limits.min_rad && angle_rad <= limits.max_rad;
}

JointLimits knee_limits(const JointLimits& bend, double sign) {
  JointLimits knee = bend;
  if (sign < 0.0) {
    knee.min_rad = -bend.max_rad;
    knee.max_rad = -bend.min_rad;
  }
  return knee;
}

/// A vector of the leg's plane, turned by the abduction about x.
Eigen::Vector3d turned_about_x(double angle_rad, const Eigen::Vector3d& v) {
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  return {v.x(), c * v.y() - s * v.z(), s * v.y() + c * v.z()};
}

}  // namespace

const char* name(Reach reach) {
  switch (reach) {
    case Reach::kReachable:
      return "reachable";
    case Reach::kNotFinite:
      return "not finite";
    case Reach::kTooFar:
      return "too far";
    case Reach::kTooNear:
      return "too near";
    case Reach::kAtHipAxis:
      return "at the hip's axis";
    case Reach::kAbductionLimit:
      return "abduction limit";
    case Reach::kHipLimit:
      return "hip limit";
    case Reach::kKneeLimit:
      return "knee limit";
  }
  return "?";
}

LegKinematics::LegKinematics(const RobotParams& robot) : robot_(robot) {
  for (const Leg leg : kLegs) {
    limits_[leg] = {robot.abduction, robot.hip, knee_limits(robot.knee_bend, robot.knee_sign[leg])};
  }
}

Eigen::Vector3d LegKinematics::hip_m(Leg leg) const {
  return {lengthwise_sign(leg) * robot_.hip_x_m, lateral_sign(leg) * robot_.hip_y_m, 0.0};
}

Eigen::Vector3d LegKinematics::foot_m(Leg leg, const LegAngles& angles_rad) const {
  const double thigh_rad = angles_rad[1];
  const double shank_rad = angles_rad[1] + angles_rad[2];
  const Eigen::Vector3d in_plane(
      -robot_.thigh_m * std::sin(thigh_rad) - robot_.shank_m * std::sin(shank_rad),
      lateral_sign(leg) * robot_.abduction_m,
      -robot_.thigh_m * std::cos(thigh_rad) - robot_.shank_m * std::cos(shank_rad));
  return hip_m(leg) + turned_about_x(angles_rad[0], in_plane);
}

LegSolution LegKinematics::inverse(Leg leg, const Eigen::Vector3d& foot_m) const {
  if (!foot_m.allFinite()) return {Reach::kNotFinite};
  const Eigen::Vector3d v = foot_m - hip_m(leg);
  const double l2 = robot_.thigh_m;
  const double l3 = robot_.shank_m;

  // Depth of the foot below the hip in the leg's plane; the abduction puts it there.
  const double depth2_m2 = v.y() * v.y() + v.z() * v.z() - robot_.abduction_m * robot_.abduction_m;
  if (!(depth2_m2 >= robot_.min_height_m * robot_.min_height_m)) return {Reach::kAtHipAxis};
  const double depth_m = std::sqrt(depth2_m2);
  const double abduction_rad = wrapped(
      std::atan2(v.z(), v.y()) - std::atan2(-depth_m, lateral_sign(leg) * robot_.abduction_m));

  // Knee by the law of cosines, on the leg's branch.
  const double reach2_m2 = v.x() * v.x() + depth2_m2;
  const double cos_knee = (reach2_m2 - l2 * l2 - l3 * l3) / (2.0 * l2 * l3);
  if (cos_knee > 1.0) return {Reach::kTooFar};
  if (!(cos_knee >= -1.0)) return {Reach::kTooNear};
  const double knee_rad = robot_.knee_sign[leg] * std::acos(cos_knee);
  const double hip_rad = wrapped(std::atan2(-v.x(), depth_m) -
                                 std::atan2(l3 * std::sin(knee_rad), l2 + l3 * std::cos(knee_rad)));

  if (!within(limits(leg, 0), abduction_rad)) return {Reach::kAbductionLimit};
  if (!within(limits(leg, 1), hip_rad)) return {Reach::kHipLimit};
  if (!within(limits(leg, 2), knee_rad)) return {Reach::kKneeLimit};
  return {Reach::kReachable, LegAngles(abduction_rad, hip_rad, knee_rad)};
}

Eigen::Matrix3d LegKinematics::jacobian(Leg leg, const LegAngles& angles_rad) const {
  const double s1 = std::sin(angles_rad[1]);
  const double c1 = std::cos(angles_rad[1]);
  const double s12 = std::sin(angles_rad[1] + angles_rad[2]);
  const double c12 = std::cos(angles_rad[1] + angles_rad[2]);
  const Eigen::Vector3d by_knee(-robot_.shank_m * c12, 0.0, robot_.shank_m * s12);
  const Eigen::Vector3d by_hip(by_knee.x() - robot_.thigh_m * c1, 0.0,
                               by_knee.z() + robot_.thigh_m * s1);
  const Eigen::Vector3d from_axis = foot_m(leg, angles_rad) - hip_m(leg);
  Eigen::Matrix3d result;
  result.col(0) = Eigen::Vector3d(0.0, -from_axis.z(), from_axis.y());
  result.col(1) = turned_about_x(angles_rad[0], by_hip);
  result.col(2) = turned_about_x(angles_rad[0], by_knee);
  return result;
}

Eigen::Matrix3d LegKinematics::R_body_claw(Leg leg, const LegAngles& angles_rad) const {
  const double pitch_rad = angles_rad[1] + angles_rad[2] - lengthwise_sign(leg) * robot_.wrist_rad;
  const double c = std::cos(pitch_rad);
  const double s = std::sin(pitch_rad);
  Eigen::Matrix3d result;
  result.col(0) = turned_about_x(angles_rad[0], Eigen::Vector3d(c, 0.0, -s));
  result.col(1) = turned_about_x(angles_rad[0], Eigen::Vector3d::UnitY());
  result.col(2) = turned_about_x(angles_rad[0], Eigen::Vector3d(s, 0.0, c));
  return result;
}

Eigen::Vector3d LegKinematics::seat_m(Leg leg, const LegAngles& angles_rad) const {
  const Eigen::Matrix3d R = R_body_claw(leg, angles_rad);
  return foot_m(leg, angles_rad) + robot_.claw.seat_up_m * R.col(0) +
         robot_.claw.seat_out_m * R.col(2);
}

Eigen::Vector3d LegKinematics::retract_direction(Leg leg, const LegAngles& angles_rad) const {
  return R_body_claw(leg, angles_rad).col(2);
}

double LegKinematics::limit_margin_rad(Leg leg, const LegAngles& angles_rad) const {
  if (!angles_rad.allFinite()) return std::numeric_limits<double>::quiet_NaN();
  double margin_rad = std::numeric_limits<double>::infinity();
  for (int joint = 0; joint < kNumLegJoints; ++joint) {
    const JointLimits& limit = limits(leg, joint);
    margin_rad = std::min(
        {margin_rad, angles_rad[joint] - limit.min_rad, limit.max_rad - angles_rad[joint]});
  }
  return margin_rad;
}

LegAngles LegKinematics::clamped(Leg leg, const LegAngles& angles_rad) const {
  LegAngles result;
  for (int joint = 0; joint < kNumLegJoints; ++joint) {
    result[joint] =
        std::clamp(angles_rad[joint], limits(leg, joint).min_rad, limits(leg, joint).max_rad);
  }
  return result;
}

double smallest_singular_value(const Eigen::Matrix3d& jacobian) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.compute(jacobian.transpose() * jacobian, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()[0]));
}

}  // namespace climb
