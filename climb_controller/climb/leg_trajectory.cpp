// SPDX-License-Identifier: BSD-3-Clause
#include "climb/leg_trajectory.h"

#include <algorithm>
#include <cmath>

namespace climb {
namespace {

constexpr double kMaxSlope = 1.875;          ///< of the quintic, at u = 1/2
constexpr double kMaxCurvature = 5.7735027;  ///< 10 / sqrt(3), at u = (3 -+ sqrt(3)) / 6

/// Fraction of a motion at time t; before = 0, after = 1, NaN = 0.
double fraction(double t_s, double duration_s) {
  if (!(t_s > 0.0)) return 0.0;
  return t_s < duration_s ? t_s / duration_s : 1.0;
}

}  // namespace

Quintic quintic(double u) {
  return {u * u * u * (10.0 + u * (6.0 * u - 15.0)), 30.0 * u * u * (1.0 - u) * (1.0 - u),
          60.0 * u * (1.0 - u) * (1.0 - 2.0 * u)};
}

double quintic_duration_s(double distance, double max_speed, double max_acceleration) {
  const double length = std::abs(distance);
  return std::max(kMaxSlope * length / max_speed,
                  std::sqrt(kMaxCurvature * length / max_acceleration));
}

JointSegment::JointSegment(const LegAngles& from_rad, const LegAngles& to_rad,
                           const LegLimits& limits, double min_duration_s) {
  valid_ = from_rad.allFinite() && to_rad.allFinite() && std::isfinite(min_duration_s);
  if (from_rad.allFinite()) from_rad_ = from_rad;
  to_rad_ = valid_ ? to_rad : from_rad_;
  if (!valid_) return;
  duration_s_ = std::max(0.0, min_duration_s);
  for (int joint = 0; joint < kNumLegJoints; ++joint) {
    duration_s_ = std::max(duration_s_, quintic_duration_s(to_rad[joint] - from_rad[joint],
                                                           limits[joint].max_velocity_rad_s,
                                                           limits[joint].max_acceleration_rad_s2));
  }
}

JointSample JointSegment::at(double t_s) const {
  const double u = fraction(t_s, duration_s_);
  if (u <= 0.0 && duration_s_ > 0.0) return {from_rad_};
  if (u >= 1.0 || duration_s_ <= 0.0) return {to_rad_};
  const Quintic s = quintic(u);
  const LegAngles way_rad = to_rad_ - from_rad_;
  return {from_rad_ + s.value * way_rad, (s.slope / duration_s_) * way_rad,
          (s.curvature / (duration_s_ * duration_s_)) * way_rad};
}

Line::Line(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m, double max_speed_m_s,
           double max_acceleration_m_s2, double min_duration_s) {
  valid_ = from_m.allFinite() && to_m.allFinite() && max_speed_m_s > 0.0 &&
           max_acceleration_m_s2 > 0.0 && std::isfinite(min_duration_s);
  if (from_m.allFinite()) from_m_ = from_m;
  to_m_ = valid_ ? to_m : from_m_;
  if (!valid_) return;
  duration_s_ = std::max(
      {0.0, min_duration_s, quintic_duration_s(length_m(), max_speed_m_s, max_acceleration_m_s2)});
}

LineSample Line::at(double t_s) const {
  const double u = fraction(t_s, duration_s_);
  if (u <= 0.0 && duration_s_ > 0.0) return {from_m_};
  if (u >= 1.0 || duration_s_ <= 0.0) return {to_m_};
  const Quintic s = quintic(u);
  const Eigen::Vector3d way_m = to_m_ - from_m_;
  return {from_m_ + s.value * way_m, (s.slope / duration_s_) * way_m,
          (s.curvature / (duration_s_ * duration_s_)) * way_m};
}

LegLimits leg_limits(const LegKinematics& kinematics, Leg leg) {
  LegLimits limits = {kinematics.limits(leg, 0), kinematics.limits(leg, 1),
                      kinematics.limits(leg, 2)};
  for (JointLimits& joint : limits) {
    const double stoppable_rad_s = kMaxStop_s * joint.max_acceleration_rad_s2;
    joint.max_velocity_rad_s = std::min(joint.max_velocity_rad_s, stoppable_rad_s);
  }
  return limits;
}

LegAngles clamp_step(const LegAngles& last_rad, const LegAngles& wish_rad, const LegLimits& limits,
                     double dt_s) {
  LegAngles result = last_rad;
  for (int joint = 0; joint < kNumLegJoints; ++joint) {
    if (!std::isfinite(wish_rad[joint]) || !std::isfinite(last_rad[joint])) continue;
    if (!(dt_s > 0.0)) continue;
    const double step_rad = limits[joint].max_velocity_rad_s * dt_s;
    const double inside_rad =
        std::clamp(wish_rad[joint], limits[joint].min_rad, limits[joint].max_rad);
    result[joint] = std::clamp(inside_rad, last_rad[joint] - step_rad, last_rad[joint] + step_rad);
  }
  return result;
}

}  // namespace climb
