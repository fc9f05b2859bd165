// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/motion.h"

#include <cmath>
#include <numbers>

namespace simulator {
namespace {

using Eigen::Vector3d;

/// Neither direction is an axis of any scene, so that every error shows everywhere.
const Vector3d kSwayDirection(0.5, 0.8660254037844386, 0.0);
const Vector3d kSwayAxis(0.5773502691896258, 0.5773502691896258, 0.5773502691896258);

}  // namespace

std::string check(const MotionParams& params) {
  if (!(params.sway_m >= 0.0 && params.sway_m <= 1.0)) return "sway_m must be in [0, 1]";
  if (!(params.sway_deg >= 0.0 && params.sway_deg <= 45.0)) return "sway_deg must be in [0, 45]";
  if (!(params.sway_hz > 0.0 && params.sway_hz <= 5.0)) return "sway_hz must be in (0, 5]";
  if (!(std::abs(params.climb_m_s) <= 1.0)) return "climb_m_s must be in [-1, 1]";
  return "";
}

Eigen::Isometry3d moved(const MotionParams& params, const Eigen::Isometry3d& T_world_body,
                        double t_s) {
  if (!params.any()) return T_world_body;
  const double wave = std::sin(2.0 * std::numbers::pi * params.sway_hz * t_s);
  const double angle_rad = params.sway_deg * wave * std::numbers::pi / 180.0;
  Eigen::Isometry3d result = T_world_body;
  result.translation() +=
      params.sway_m * wave * kSwayDirection + params.climb_m_s * t_s * Vector3d::UnitZ();
  result.linear() =
      Eigen::AngleAxisd(angle_rad, kSwayAxis).toRotationMatrix() * T_world_body.linear();
  return result;
}

BodyMotion motion_at(const MotionParams& params, const Eigen::Isometry3d& T_world_body,
                     double t_s) {
  constexpr double kStep_s = 1e-3;  // differences of a smooth path
  const Eigen::Isometry3d before = moved(params, T_world_body, t_s - kStep_s);
  const Eigen::Isometry3d now = moved(params, T_world_body, t_s);
  const Eigen::Isometry3d after = moved(params, T_world_body, t_s + kStep_s);
  const Eigen::AngleAxisd turn(before.linear().transpose() * after.linear());
  return {
      (before.translation() - 2.0 * now.translation() + after.translation()) / (kStep_s * kStep_s),
      turn.angle() / (2.0 * kStep_s) * turn.axis()};
}

}  // namespace simulator
