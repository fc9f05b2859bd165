// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/plant/motor.h"

#include <algorithm>
#include <cmath>

namespace simulator {

Motor::Motor(const MotorParams& params, double position_rad)
    : params_(params), position_rad_(position_rad), lower_stop_rad_(params.min_rad) {}

void Motor::set_position(double position_rad) {
  position_rad_ = position_rad;
  velocity_rad_s_ = 0.0;
}

void Motor::follow(const MotorTarget& target, const MotorLimits& limits, double dt_s) {
  if (outside_) return command_follow(target, limits);
  const double error = target.position_rad - position_rad_;
  // Never faster than can be braked before the target, else the limited acceleration overshoots.
  const double brakable = std::sqrt(2.0 * params_.max_acceleration_rad_s2 * std::fabs(error));
  const double wanted = std::min(std::fabs(error) / params_.lag_s, brakable);
  step((error < 0.0 ? -wanted : wanted) + target.feed_forward_rad_s, limits, dt_s);
}

void Motor::ramp_down(double deceleration_rad_s2, const MotorLimits& limits, double dt_s) {
  if (outside_) return command_ramp(deceleration_rad_s2, limits, dt_s);
  const double slower =
      std::max(0.0, std::fabs(velocity_rad_s_) - std::max(deceleration_rad_s2, 0.1) * dt_s);
  step(velocity_rad_s_ < 0.0 ? -slower : slower, limits, dt_s);
}

void Motor::command_follow(const MotorTarget& target, const MotorLimits& limits) {
  command_.kind = stuck ? MotorCommand::Kind::kBrake : MotorCommand::Kind::kFollow;
  command_.target_rad = reversed ? 2.0 * position_rad_ - target.position_rad : target.position_rad;
  command_.velocity_rad_s = reversed ? -target.velocity_rad_s : target.velocity_rad_s;
  command_.torque_Nm = target.torque_Nm;
  command_.torque_limit_Nm = std::min(params_.peak_torque_Nm, limits.torque_Nm);
}

void Motor::command_ramp(double deceleration_rad_s2, const MotorLimits& limits, double dt_s) {
  // The demand slows down from its own speed, so that the joint feels no step.
  if (command_.kind != MotorCommand::Kind::kFollow) command_.target_rad = position_rad_;
  const double slower =
      std::max(0.0, std::fabs(command_.velocity_rad_s) - std::max(deceleration_rad_s2, 0.1) * dt_s);
  command_.kind = MotorCommand::Kind::kFollow;
  command_.velocity_rad_s = command_.velocity_rad_s < 0.0 ? -slower : slower;
  command_.target_rad += command_.velocity_rad_s * dt_s;
  command_.torque_limit_Nm = std::min(params_.peak_torque_Nm, limits.torque_Nm);
}

void Motor::observe(const MotorState& state) {
  position_rad_ = state.position_rad;
  velocity_rad_s_ = state.velocity_rad_s;
  torque_Nm_ = state.torque_Nm;
  saturated_ = command_.kind == MotorCommand::Kind::kFollow &&
               std::fabs(state.torque_Nm) >= command_.torque_limit_Nm;
}

void Motor::step(double wanted_rad_s, const MotorLimits& limits, double dt_s) {
  const double max_velocity =
      std::min(params_.max_velocity_rad_s * speed_share, limits.velocity_rad_s);
  double wanted = std::clamp(wanted_rad_s, -max_velocity, max_velocity);
  if (reversed) wanted = -wanted;
  if (wanted < 0.0 && position_rad_ <= lower_stop()) wanted = 0.0;  // leans on its stop
  const double max_change = params_.max_acceleration_rad_s2 * dt_s;
  const double change = std::clamp(wanted - velocity_rad_s_, -max_change, max_change);
  const double torque_limit = std::min(params_.peak_torque_Nm, limits.torque_Nm);
  const double asked_Nm = params_.inertia_kg_m2 * change / dt_s + load_Nm_;
  torque_Nm_ = std::clamp(asked_Nm, -torque_limit, torque_limit);
  saturated_ = torque_Nm_ != asked_Nm;
  // Unsaturated the change is exact, so that a ramp ends at exactly 0.
  velocity_rad_s_ += saturated_ ? (torque_Nm_ - load_Nm_) / params_.inertia_kg_m2 * dt_s : change;
  velocity_rad_s_ =
      std::clamp(velocity_rad_s_, -params_.max_velocity_rad_s, params_.max_velocity_rad_s);
  move(dt_s);
}

void Motor::release(bool brake, double dt_s) {
  command_ = {brake ? MotorCommand::Kind::kBrake : MotorCommand::Kind::kOff, position_rad_, 0.0,
              0.0, 0.0};
  if (outside_) return;
  torque_Nm_ = 0.0;
  saturated_ = false;
  if (brake) {
    velocity_rad_s_ = 0.0;
    return;
  }
  // Gear friction lets a loaded joint creep, not fly.
  constexpr double kCreep_rad_s_Nm = 0.1;
  velocity_rad_s_ = std::clamp(-load_Nm_ * kCreep_rad_s_Nm, -params_.max_velocity_rad_s,
                               params_.max_velocity_rad_s);
  move(dt_s);
}

double Motor::lower_stop() const {
  return std::max(params_.min_rad, lower_stop_rad_);
}

void Motor::move(double dt_s) {
  if (stuck) velocity_rad_s_ = 0.0;
  position_rad_ += velocity_rad_s_ * dt_s;
  const double lower = lower_stop();
  if (position_rad_ < lower || position_rad_ > params_.max_rad) {
    position_rad_ = std::clamp(position_rad_, lower, params_.max_rad);
    velocity_rad_s_ = 0.0;
  }
}

}  // namespace simulator
