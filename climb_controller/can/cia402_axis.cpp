// SPDX-License-Identifier: BSD-3-Clause
#include "can/cia402_axis.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"

namespace can {

using cia402::Goal;
using cia402::NmtState;

namespace {
constexpr Parts kTorqueParts = bit(Part::kTorqueLimit) | bit(Part::kTorqueActual);
}

Cia402Axis::Cia402Axis(int index, const AxisConfig& config, const Cia402Params& params)
    : config_(config),
      index_(index),
      sdo_(index, config.node_id, params.sdo),
      steps_(configuration_of(config, params)) {}

void Cia402Axis::begin_configuration(std::int64_t now_us) {
  is_configured_ = false;
  is_under_configuration_ = true;
  network_state_ = NmtState::kPreOperational;
  forget(now_us);
  sdo_.start(steps_, config_.has_torque ? Parts{0} : Parts{kTorqueParts});
}

void Cia402Axis::finish_configuration() {
  is_configured_ = true;
  is_under_configuration_ = false;
  // Found enabled, by a master before this one: it stops and holds, and follows nobody before
  // enable(). A drive that would not hold after a quick stop goes on holding as it does.
  if (state_ == DriveState::kOperationEnabled && !sdo_.lacks(Part::kHoldOnLoss)) {
    goal_ = Goal::kQuickStop;
  }
}

bool Cia402Axis::is_running() const {
  return network_state_ == NmtState::kOperational && has_status_;
}

void Cia402Axis::forget(std::int64_t now_us) {
  heartbeat_us_ = now_us;
  has_status_ = false;
  is_fresh_ = false;
  state_ = DriveState::kUnknown;
  num_missed_ = 0;
  goal_ = Goal::kKeep;
  expects_torque_ = false;
  may_quick_stop_ = false;
  is_broken_ = false;
  is_resetting_ = false;
  command_ = {};
  command_.max_torque_permille = limit_permille(config_, config_.max_torque_Nm).value_or(0);
}

void Cia402Axis::raise(BusLine& line, FaultCause cause, std::uint32_t detail) {
  if (cause != FaultCause::kWarning) break_off(cause == FaultCause::kSilent);
  line.raise(cause, index_, detail);
}

void Cia402Axis::break_off(bool is_silent) {
  is_broken_ = true;
  if (goal_ == Goal::kEnabled) goal_ = Goal::kKeep;
  keep_stopped();
  // Who is not heard may not hear us either, and then stops by itself: 0Fh on our view from before
  // would undo that as soon as it listens again. A drive that would go limp is told nothing new.
  if (goal_ == Goal::kKeep && is_silent && !sdo_.lacks(Part::kHoldOnLoss)) {
    set_goal(Goal::kQuickStop);
  }
}

bool Cia402Axis::take(const CanFrame& frame, BusLine& line, std::int64_t now_us) {
  switch (is_plain(frame) ? cia402::kind_of(frame.id) : cia402::FrameKind::kOther) {
    case cia402::FrameKind::kTpdo1:
      return take_tpdo1(frame);
    case cia402::FrameKind::kTpdo2:
      return take_tpdo2(frame);
    default:
      break;
  }
  if (const auto emergency = cia402::decode_emergency(frame)) {
    take_emergency(*emergency, line);
    return true;
  }
  if (const auto heartbeat = cia402::decode_heartbeat(frame)) {
    take_heartbeat(heartbeat->state, line, now_us);
    return true;
  }
  if (const auto response = cia402::decode_sdo_response(frame)) {
    sdo_.take(*response);
    return true;
  }
  return false;
}

bool Cia402Axis::knows_layout() const {
  return is_configured_ || (is_under_configuration_ && sdo_.is_done());
}

bool Cia402Axis::take_tpdo1(const CanFrame& frame) {
  if (!knows_layout()) return true;
  const auto pdo = cia402::decode_tpdo1(frame);
  if (!pdo || pdo->torque_permille.has_value() == sdo_.lacks(Part::kTorqueActual)) return false;
  take_status(*pdo);
  return true;
}

bool Cia402Axis::take_tpdo2(const CanFrame& frame) {
  if (!knows_layout() || sdo_.lacks(Part::kDetails)) return true;
  const auto pdo = cia402::decode_tpdo2(frame);
  if (!pdo) return false;
  error_code_ = pdo->error_code;
  digital_inputs_ = pdo->digital_inputs;
  return true;
}

void Cia402Axis::take_status(const cia402::Tpdo1& pdo) {
  status_word_ = pdo.status_word;
  state_ = cia402::state_of(pdo.status_word);
  keep_stopped();
  position_counts_ = pdo.position_counts;
  torque_permille_ = pdo.torque_permille.value_or(0);
  // Until it follows targets, the target is where it stands.
  if (!has_status_ || state_ != DriveState::kOperationEnabled) command_.counts = position_counts_;
  has_status_ = true;
  is_doubted_ = false;
  is_fresh_ = true;
}

void Cia402Axis::take_emergency(const cia402::Emergency& emergency, BusLine& line) {
  error_code_ = emergency.error_code;
  if (emergency.error_code == 0) return;
  // Re-arming, we say nothing for some cycles ourselves.
  if (is_resetting_ && cia402::is_master_silent_code(emergency.error_code)) return;
  raise(
      line,
      cia402::is_warning_code(emergency.error_code) ? FaultCause::kWarning : FaultCause::kEmergency,
      emergency.error_code);
}

void Cia402Axis::take_heartbeat(NmtState state, BusLine& line, std::int64_t now_us) {
  heartbeat_us_ = now_us;
  network_state_ = state;
  if (state == NmtState::kBootUp) {
    const bool is_expected = !is_configured_ && !is_under_configuration_;  // power was switched on
    forget(now_us);
    is_configured_ = false;
    if (!is_expected) raise(line, FaultCause::kUnexpectedBootUp, 0);
  } else if (is_configured_ && state != NmtState::kOperational) {
    raise(line, FaultCause::kLeftOperational, static_cast<std::uint32_t>(state));
  }
}

void Cia402Axis::watch_cycle(BusLine& line, bool expects_frames) {
  was_fresh_ = is_fresh_;
  is_fresh_ = false;
  if (!is_configured_) return;
  if (was_fresh_) {
    num_missed_ = 0;
  } else if (expects_frames) {
    ++num_missed_;
  }
  if (state_ == DriveState::kOperationEnabled && goal_ == Goal::kEnabled) {
    expects_torque_ = true;
    may_quick_stop_ = false;
  }
  const bool holds = state_ == DriveState::kOperationEnabled ||
                     (state_ == DriveState::kQuickStopActive && may_quick_stop_);
  const bool failed = !is_resetting_ &&
                      (state_ == DriveState::kFault || state_ == DriveState::kFaultReactionActive);
  if (failed || (expects_torque_ && !holds)) {
    raise(line, FaultCause::kLeftOperationEnabled, status_word_);
  }
}

void Cia402Axis::watch_time(BusLine& line, const Cia402Params& params, std::int64_t now_us) {
  if (!is_configured_) return;
  if (num_missed_ >= params.max_missed_cycles) {
    raise(line, FaultCause::kSilent, static_cast<std::uint32_t>(num_missed_));
  }
  const std::int64_t silent_ms = (now_us - heartbeat_us_) / 1000;
  if (silent_ms > params.drive_lost_ms) {
    raise(line, FaultCause::kHeartbeatLost, static_cast<std::uint32_t>(silent_ms));
  }
}

void Cia402Axis::fill(AxisFeedback& feedback) const {
  feedback.state = state_;
  feedback.fresh = was_fresh_;
  feedback.missed_cycles = num_missed_;
  feedback.status_word = status_word_;
  feedback.error_code = error_code_;
  feedback.digital_inputs = digital_inputs_;
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  feedback.position_rad = has_status_ ? rad_from_counts(config_, position_counts_) : kNone;
  feedback.torque_Nm = has_status_ && !sdo_.lacks(Part::kTorqueActual)
                           ? Nm_from_permille(config_, torque_permille_)
                           : kNone;
}

void Cia402Axis::set_goal(Goal goal) {
  if (goal == Goal::kEnabled && is_broken_) goal = Goal::kKeep;
  if (goal == Goal::kKeep && goal_ == Goal::kQuickStop) return;  // it holds already
  if (goal == Goal::kDisabled || goal == Goal::kNoTorque) expects_torque_ = false;
  if (goal == Goal::kQuickStop) may_quick_stop_ = true;  // and until it is enabled again
  goal_ = goal;
  keep_stopped();
}

void Cia402Axis::keep_stopped() {
  // An enabling word still on its way may wake up one that holds by itself: it is stopped again,
  // else it would be told 0Fh and 0Bh in turns.
  if (goal_ == Goal::kKeep && state_ == DriveState::kQuickStopActive) goal_ = Goal::kQuickStop;
}

bool Cia402Axis::offer_target(const AxisTarget& target) {
  const auto counts = counts_from_rad(config_, target.position_rad);
  if (!counts || !(target.max_torque_Nm >= 0.0)) return false;
  const double velocity = target.velocity_rad_s * config_.sign;
  const auto speed = limit_counts(config_, std::fabs(velocity));
  const auto torque = permille_from_Nm(config_, target.torque_Nm);
  const auto permille =
      limit_permille(config_, std::min(target.max_torque_Nm, config_.max_torque_Nm));
  if (!speed || *speed > std::numeric_limits<std::int32_t>::max() || !torque || !permille) {
    return false;
  }
  const auto magnitude = static_cast<std::int32_t>(*speed);
  offered_ = {*counts, *permille, velocity < 0.0 ? -magnitude : magnitude, *torque};
  return true;
}

void Cia402Axis::accept_target() {
  if (goal_ == Goal::kEnabled && state_ == DriveState::kOperationEnabled) command_ = offered_;
}

cia402::Rpdo1 Cia402Axis::next_rpdo1() {
  CHECK(may_send(), "a drive is told nothing before it has said its state");
  const bool keeps = goal_ == Goal::kKeep || goal_ == Goal::kEnabled;
  if (is_resetting_ && state_ == DriveState::kFault) {
    control_word_ = cia402::reset_control_word(control_word_);
  } else if (state_ != DriveState::kUnknown || !keeps) {
    control_word_ = cia402::control_word(goal_, state_);
  }  // else: a statusword outside the standard; 00h could drop the limb, so the last word stays
  cia402::Rpdo1 pdo{node(), control_word_, command_.counts, std::nullopt};
  if (!sdo_.lacks(Part::kTorqueLimit)) pdo.max_torque_permille = command_.max_torque_permille;
  return pdo;
}

cia402::Rpdo2 Cia402Axis::next_rpdo2() const {
  const bool moves = state_ == DriveState::kOperationEnabled && goal_ == Goal::kEnabled;
  if (!moves) return {node(), 0, 0, 8};
  return {node(), command_.velocity_counts_s, command_.torque_permille, 8};
}

}  // namespace can
