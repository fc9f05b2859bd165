// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/plant/plant_kinematics.h"

#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace simulator {
namespace {

/// Hip and knee move the foot in the leg's plane: x forward, height along the leg's own z.
struct InPlane {
  double x_m;
  double height_m;
};

InPlane in_plane(const RobotGeometry& geometry, double hip_rad, double knee_rad) {
  const double shank_rad = hip_rad + knee_rad;
  return {-geometry.thigh_m * std::sin(hip_rad) - geometry.shank_m * std::sin(shank_rad),
          -geometry.thigh_m * std::cos(hip_rad) - geometry.shank_m * std::cos(shank_rad)};
}

}  // namespace

Eigen::Vector3d foot_in_body(const RobotGeometry& geometry, int leg, const LegAngles& angles) {
  const InPlane foot = in_plane(geometry, angles[1], angles[2]);
  const double side_m = left_sign(leg) * geometry.abduction_m;
  const double c = std::cos(angles[0]);
  const double s = std::sin(angles[0]);
  return {forward_sign(leg) * geometry.hip_x_m + foot.x_m,
          left_sign(leg) * geometry.hip_y_m + c * side_m - s * foot.height_m,
          s * side_m + c * foot.height_m};
}

Eigen::Matrix3d foot_jacobian(const RobotGeometry& geometry, int leg, const LegAngles& angles) {
  const Eigen::Vector3d foot = foot_in_body(geometry, leg, angles);
  const double c = std::cos(angles[0]);
  const double s = std::sin(angles[0]);
  const Eigen::Vector3d abduction_origin(forward_sign(leg) * geometry.hip_x_m,
                                         left_sign(leg) * geometry.hip_y_m, 0.0);
  const double side_m = left_sign(leg) * geometry.abduction_m;
  const Eigen::Vector3d hip = abduction_origin + Eigen::Vector3d(0.0, c * side_m, s * side_m);
  const InPlane knee_place = in_plane({0.0, 0.0, 0.0, geometry.thigh_m, 0.0}, angles[1], 0.0);
  const Eigen::Vector3d knee =
      hip + Eigen::Vector3d(knee_place.x_m, -s * knee_place.height_m, c * knee_place.height_m);
  const Eigen::Vector3d pitch_axis(0.0, c, s);
  Eigen::Matrix3d jacobian;
  jacobian.col(0) = Eigen::Vector3d::UnitX().cross(foot - abduction_origin);
  jacobian.col(1) = pitch_axis.cross(foot - hip);
  jacobian.col(2) = pitch_axis.cross(foot - knee);
  return jacobian;
}

std::optional<LegAngles> angles_for_foot(const RobotGeometry& geometry, int leg,
                                         const Eigen::Vector3d& foot_m) {
  constexpr int kMaxSteps = 200;
  constexpr double kMaxChange_rad = 0.2;
  const double knee_sign = forward_sign(leg);
  LegAngles angles(0.0, -0.9 * knee_sign, 1.5 * knee_sign);
  for (int i = 0; i < kMaxSteps; ++i) {
    const Eigen::Vector3d error = foot_m - foot_in_body(geometry, leg, angles);
    if (error.norm() < 1e-12) break;
    const Eigen::Matrix3d jacobian = foot_jacobian(geometry, leg, angles);
    const Eigen::Matrix3d damped =
        jacobian.transpose() * jacobian + 1e-12 * Eigen::Matrix3d::Identity();
    const Eigen::Vector3d change = damped.inverse() * (jacobian.transpose() * error);
    angles += change * std::fmin(1.0, kMaxChange_rad / std::fmax(change.norm(), 1e-15));
  }
  const bool reached = (foot_in_body(geometry, leg, angles) - foot_m).norm() < 1e-9;
  const bool on_branch = knee_sign * angles[2] > 0.0;
  if (!reached || !on_branch) return std::nullopt;
  return angles;
}

}  // namespace simulator
