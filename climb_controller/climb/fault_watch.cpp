// SPDX-License-Identifier: BSD-3-Clause
#include "climb/fault_watch.h"

#include <cmath>

#include "climb/unit.h"

namespace climb {
namespace {

constexpr int kMaxBehind = 2;

Eigen::Vector3d up_of(const ImuReading& imu) {
  return imu.q_odom_body.conjugate() * Eigen::Vector3d::UnitZ();
}

}  // namespace

bool is_sound(const ImuReading& imu) {
  return imu.valid && is_unit(imu.q_odom_body) && std::isfinite(imu.acceleration_m_s2);
}

std::string check(const WatchParams& p) {
  const auto in = [](double value, double low, double high) {  // false for NaN
    return value >= low && value <= high;
  };
  if (!in(p.period_s, 0.001, 0.1)) return "watch.period_s must be 0.001..0.1";
  if (!in(p.max_following_rad, 0.0, 6.3)) return "watch.max_following_rad must be 0..6.3";
  if (!in(p.jump_margin_rad, 0.0, 6.3)) return "watch.jump_margin_rad must be 0..6.3";
  if (!in(p.min_upright_cosine, 0.0, 1.0)) return "watch.min_upright_cosine must be 0..1";
  if (!in(p.free_fall_m_s2, 0.0, 9.0)) return "watch.free_fall_m_s2 must be 0..9";
  if (!in(p.free_fall_s, 0.0, 1.0)) return "watch.free_fall_s must be 0..1";
  if (p.max_ladder_age_us <= 0) return "watch.max_ladder_age_us must be above 0";
  return "";
}

FaultWatch::FaultWatch(const PerAxis<AxisLimits>& limits, const WatchParams& params)
    : limits_(limits), params_(params) {}

void FaultWatch::arm(const ControllerInput& input) {
  armed_ = true;
  up_body_ = up_of(input.imu);
  for (int axis = 0; axis < kNumAxes; ++axis) last_rad_[axis] = input.axes[axis].position_rad;
  num_behind_.fill(0);
}

FaultFlags FaultWatch::look(const ControllerInput& input, const PerAxis<AxisCommand>& sent) {
  FaultFlags faults = input.faults;
  if (!input.estop_clear) faults |= flag(Fault::kEstop);
  const std::int64_t age_us = input.now_us - input.ladder_received_us;
  const bool sees = age_us >= 0 && age_us <= params_.max_ladder_age_us;
  if (!sees) faults |= flag(Fault::kPerceptionSilent);
  for (const AxisReading& axis : input.axes) {
    if (!axis.valid || !std::isfinite(axis.position_rad)) faults |= flag(Fault::kServoSilent);
  }
  faults |= look_at_imu(input.imu);
  if (armed_ && look_at_drives(input, sent)) faults |= flag(Fault::kTracking);
  return faults;
}

bool FaultWatch::look_at_drives(const ControllerInput& input, const PerAxis<AxisCommand>& sent) {
  bool behind = false;
  for (int axis = 0; axis < kNumAxes; ++axis) {
    const AxisReading& reading = input.axes[axis];
    if (!reading.valid) continue;
    // A jaw presses against its rung, and snaps shut when it loses it.
    if (axis % kNumAxesPerLeg == kJaw) continue;
    const double step_rad = std::abs(reading.position_rad - last_rad_[axis]);
    const double max_step_rad =
        limits_[axis].max_velocity_rad_s * params_.period_s + params_.jump_margin_rad;
    if (!(step_rad <= max_step_rad)) behind = true;
    last_rad_[axis] = reading.position_rad;
    const double error_rad = std::abs(sent[axis].position_rad - reading.position_rad);
    num_behind_[axis] = error_rad <= params_.max_following_rad ? 0 : num_behind_[axis] + 1;
    if (num_behind_[axis] >= kMaxBehind) behind = true;
  }
  return behind;
}

FaultFlags FaultWatch::look_at_imu(const ImuReading& imu) {
  if (!is_sound(imu)) return flag(Fault::kImuSilent);
  FaultFlags faults = 0;
  const bool falls = imu.acceleration_m_s2 < params_.free_fall_m_s2;
  falling_s_ = falls ? falling_s_ + params_.period_s : 0.0;
  if (falling_s_ >= params_.free_fall_s - 1e-6) faults |= flag(Fault::kFreeFall);
  const bool upright = up_of(imu).dot(up_body_) >= params_.min_upright_cosine;
  if (armed_ && !upright) faults |= flag(Fault::kTilt);
  return faults;
}

}  // namespace climb
