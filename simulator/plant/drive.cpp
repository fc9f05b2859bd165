// SPDX-License-Identifier: BSD-3-Clause
// Power states, motion and supervision of a drive.
#include "simulator/plant/drive.h"

#include <algorithm>
#include <cmath>

namespace simulator {
namespace {

constexpr double kStep_s = 1e-6 * static_cast<double>(Drive::kStep_us);
constexpr std::uint16_t kFaultResetBit = 0x80;
constexpr std::uint16_t kFollowingErrorCode = 0x8611;
constexpr std::int64_t kCyclicPositionMode = 8;

}  // namespace

std::string check(const DriveParams& params) {
  if (params.node_id < 1 || params.node_id > 126) return "node_id must be 1..126";
  if (!(params.counts_per_rad > 0.0)) return "counts_per_rad must be > 0";
  if (params.sign != 1 && params.sign != -1) return "sign must be +1 or -1";
  if (!(params.rated_torque_Nm > 0.0)) return "rated_torque_Nm must be > 0";
  if (!(params.motor.lag_s > 0.0)) return "motor.lag_s must be > 0";
  if (!(params.motor.min_rad < params.motor.max_rad)) return "motor.min_rad must be < max_rad";
  if (params.boot_us < 0) return "boot_us must be >= 0";
  return "";
}

Drive::Drive(const DriveParams& params)
    : params_(params),
      dictionary_(params.node_id, params.objects, params.rated_torque_Nm),
      motor_(params.motor, params.start_rad) {
  reset_node(false, 0);
}

std::int32_t Drive::counts(double angle_rad) const {
  const double exact = params_.sign * (angle_rad - params_.offset_rad) * params_.counts_per_rad;
  return static_cast<std::int32_t>(std::floor(std::clamp(exact, -2e9, 2e9) + 0.5));
}

double Drive::angle_rad(double position_counts) const {
  return params_.sign * position_counts / params_.counts_per_rad + params_.offset_rad;
}

double Drive::demand_rad() const {
  return angle_rad(demand_);
}

double Drive::torque_limit_Nm() const {
  return static_cast<double>(dictionary_.number(0x6072)) * 1e-3 * params_.rated_torque_Nm;
}

std::uint16_t Drive::error_code() const {
  return static_cast<std::uint16_t>(dictionary_.number(0x603F));
}

void Drive::set_digital_inputs(std::uint32_t bits) {
  dictionary_.at(0x60FD).value = bits;
}

void Drive::advance(std::int64_t now_us, std::vector<BusFrame>& sent) {
  for (; next_step_us_ <= now_us; next_step_us_ += kStep_us) step(next_step_us_, sent);
}

void Drive::step(std::int64_t now_us, std::vector<BusFrame>& sent) {
  const std::size_t first_sent = sent.size();
  if (nmt_ == NmtState::kBooting) {
    motor_.release(params_.brake_when_off, kStep_s);
    if (now_us >= boot_due_us_) boot(now_us, sent);
  } else {
    watch_master(now_us, sent);
    move_motor(now_us);
    finish_ramps();
    watch_following_error(sent);
    refresh_objects();
    send_timed(now_us, sent);
  }
  if (faults.silent) sent.resize(first_sent);
}

void Drive::apply_control_word(std::vector<BusFrame>& sent) {
  const auto word = static_cast<std::uint16_t>(dictionary_.number(0x6040));
  ControlInputs inputs;
  inputs.control_word = word;
  inputs.fault_reset_edge =
      (word & kFaultResetBit) != 0 && (last_control_word_ & kFaultResetBit) == 0;
  inputs.fault_cause_gone = !motor_.stuck;
  // Transition 16 goes by level, not edge: a master that comes back still saying 0x0F moves at
  // once.
  inputs.leaves_quick_stop = dictionary_.number(0x605A) >= 5 && !master_lost_;
  last_control_word_ = word;
  PowerState next = next_state(power_, inputs);
  if (!torque_permitted_ && has_torque(next)) next = PowerState::kSwitchOnDisabled;
  const bool was_fault = power_ == PowerState::kFault;
  if (next == PowerState::kQuickStopActive && power_ != next) {
    quick_stop();
  } else if (next != power_) {
    enter(next);
  }
  if (was_fault && power_ != PowerState::kFault) send_emergency(0, sent);
}

void Drive::enter(PowerState next) {
  if (next == PowerState::kOperationEnabled) {
    demand_ = static_cast<double>(counts(measured_rad()));
    demand_from_ = demand_to_ = demand_;
    following_error_us_ = 0;
  }
  power_ = next;
}

void Drive::quick_stop() {
  const bool immediately = dictionary_.number(0x605A) == 0;
  enter(immediately ? PowerState::kSwitchOnDisabled : PowerState::kQuickStopActive);
}

void Drive::start_fault_reaction() {
  if (power_ == PowerState::kFault || power_ == PowerState::kFaultReactionActive) return;
  const bool ramps = has_torque(power_) && dictionary_.number(0x605E) != 0;
  enter(ramps ? PowerState::kFaultReactionActive : PowerState::kFault);
}

void Drive::raise_fault(std::uint16_t code, std::vector<BusFrame>& sent) {
  if (power_ == PowerState::kFault) return;
  start_fault_reaction();
  send_emergency(code, sent);
}

void Drive::raise_warning(std::uint16_t code, std::vector<BusFrame>& sent) {
  warning_ = true;
  send_emergency(code, sent);
}

void Drive::clear_warning(std::vector<BusFrame>& sent) {
  if (!warning_) return;
  warning_ = false;
  send_emergency(0, sent);
}

void Drive::set_torque_permitted(bool permitted) {
  torque_permitted_ = permitted;
  if (!permitted && has_torque(power_)) enter(PowerState::kSwitchOnDisabled);
}

void Drive::apply_target(std::int64_t now_us) {
  if (power_ != PowerState::kOperationEnabled) return;
  if (dictionary_.number(0x6060) != kCyclicPositionMode) return;
  const auto target = static_cast<double>(dictionary_.number(0x607A));
  const auto low = static_cast<double>(dictionary_.number(0x607D, 1));
  const auto high = static_cast<double>(dictionary_.number(0x607D, 2));
  const double clamped = low <= high ? std::clamp(target, low, high) : demand_;
  limit_active_ = clamped != target;
  demand_from_ = demand_;
  demand_to_ = clamped;
  demand_start_us_ = now_us;
  double period_s = static_cast<double>(dictionary_.number(0x60C2, 1));
  for (std::int64_t exponent = dictionary_.number(0x60C2, 2); exponent < 0; ++exponent) {
    period_s *= 0.1;
  }
  demand_period_us_ = static_cast<std::int64_t>(period_s * 1e6 + 0.5);
}

void Drive::move_motor(std::int64_t now_us) {
  MotorLimits limits;
  limits.velocity_rad_s = static_cast<double>(dictionary_.number(0x607F)) / params_.counts_per_rad;
  limits.torque_Nm = torque_limit_Nm();
  if (power_ == PowerState::kOperationEnabled) {
    const std::int64_t since_us = now_us - demand_start_us_;
    const double share =
        demand_period_us_ <= 0
            ? 1.0
            : std::clamp(static_cast<double>(since_us) / static_cast<double>(demand_period_us_),
                         0.0, 1.0);
    demand_ = demand_from_ + (demand_to_ - demand_from_) * share;
    MotorTarget target;
    target.position_rad = angle_rad(demand_);
    const bool interpolates = demand_period_us_ > 0 && since_us < demand_period_us_;
    if (interpolates) {
      target.velocity_rad_s = params_.sign * (demand_to_ - demand_from_) / params_.counts_per_rad *
                              1e6 / static_cast<double>(demand_period_us_);
    }
    target.feed_forward_rad_s =
        params_.sign * static_cast<double>(dictionary_.number(0x60B1)) / params_.counts_per_rad;
    target.torque_Nm = params_.sign * static_cast<double>(dictionary_.number(0x60B2)) * 1e-3 *
                       params_.rated_torque_Nm;
    // A servo is a spring about its demand: under load the joint bends away from it and stays so.
    motor_.follow(target, limits, kStep_s);
  } else if (has_torque(power_)) {
    const double deceleration =
        static_cast<double>(dictionary_.number(0x6085)) / params_.counts_per_rad;
    motor_.ramp_down(deceleration, limits, kStep_s);
  } else {
    motor_.release(params_.brake_when_off, kStep_s);
  }
}

void Drive::finish_ramps() {
  const bool stands = motor_.stands();
  if (power_ == PowerState::kFaultReactionActive && stands) enter(PowerState::kFault);
  const bool leaves = dictionary_.number(0x605A) < 5;
  if (power_ == PowerState::kQuickStopActive && stands && leaves) {
    enter(PowerState::kSwitchOnDisabled);
  }
}

void Drive::watch_following_error(std::vector<BusFrame>& sent) {
  const std::uint32_t window = dictionary_.at(0x6065).value;
  const double error = std::fabs(demand_ - static_cast<double>(counts(measured_rad())));
  const bool outside = power_ == PowerState::kOperationEnabled && window != 0xFFFFFFFFU &&
                       error > static_cast<double>(window);
  following_error_us_ = outside ? following_error_us_ + kStep_us : 0;
  following_error_ = outside && following_error_us_ > dictionary_.number(0x6066) * 1000;
  if (following_error_) raise_fault(kFollowingErrorCode, sent);
}

std::uint16_t Drive::status_word() const {
  unsigned word = status_bits(power_) | 0x10U;
  if (nmt_ == NmtState::kOperational) word |= 0x200U;
  if (warning_) word |= 0x80U;
  if (limit_active_ || motor_.saturated()) word |= 0x800U;
  if (power_ == PowerState::kOperationEnabled) word |= 0x1000U;
  if (following_error_) word |= 0x2000U;
  return static_cast<std::uint16_t>(word);
}

void Drive::refresh_objects() {
  const double permille = params_.sign * motor_.torque_Nm() / params_.rated_torque_Nm * 1000.0;
  const double speed = params_.sign * motor_.velocity_rad_s() * params_.counts_per_rad;
  dictionary_.at(0x6041).value = status_word();
  dictionary_.at(0x6061).value = dictionary_.at(0x6060).value;
  const double told_rad = measured_rad() + faults.encoder_offset_rad;
  dictionary_.at(0x6064).value = static_cast<std::uint32_t>(counts(told_rad));
  dictionary_.at(0x606C).value = static_cast<std::uint32_t>(static_cast<std::int32_t>(speed));
  dictionary_.at(0x6077).value =
      static_cast<std::uint16_t>(static_cast<std::int16_t>(std::clamp(permille, -3e4, 3e4)));
}

}  // namespace simulator
