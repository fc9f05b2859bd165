// SPDX-License-Identifier: BSD-3-Clause
// How Cia402Bus goes from phase to phase.
#include <algorithm>

#include "can/cia402_bus.h"

namespace can {

using cia402::Goal;

bool Cia402Bus::is_cycling() const {
  switch (phase()) {
    case BusPhase::kIdle:
      return is_speaking_;  // axes that are still configured keep their rhythm
    case BusPhase::kListening:
    case BusPhase::kFaulted:
      return false;
    case BusPhase::kConfiguring:
      return is_starting_;
    default:
      return true;
  }
}

void Cia402Bus::begin_phase() {
  switch (phase()) {
    case BusPhase::kConfiguring:
      is_speaking_ = true;
      is_starting_ = false;
      fault_log().clear();  // what the drives said while the bus only listened is about the past
      claims() = {};
      issues_.clear();
      send_to_all(cia402::NmtCommand::kEnterPreOperational);
      for (Cia402Axis& axis : axes_) axis.begin_configuration(now_us());
      break;
    case BusPhase::kRearming:
      is_speaking_ = true;
      fault_log().clear();  // what the drives said while the bus only listened is about the past
      for (Cia402Axis& axis : axes_) {
        axis.forget(now_us());
        axis.set_goal(Goal::kQuickStop);  // its target is forgotten: it holds by itself
        axis.set_fault_reset(true);
      }
      break;
    case BusPhase::kEnabling:
      set_goal(Goal::kEnabled);
      break;
    case BusPhase::kDisabling:
      set_goal(Goal::kDisabled);
      break;
    case BusPhase::kFaulted:
      is_speaking_ = false;
      break;
    default:
      break;
  }
}

void Cia402Bus::advance_phase() {
  switch (phase()) {
    case BusPhase::kConfiguring:
      is_starting_ ? advance_starting() : advance_configuration();
      break;
    case BusPhase::kRearming:
      advance_rearming();
      break;
    case BusPhase::kEnabling:
      advance_enabling();
      break;
    case BusPhase::kDisabling:
      advance_disabling();
      break;
    default:
      break;
  }
}

void Cia402Bus::advance_configuration() {
  if (line().is_busy()) return;  // a request that waits behind others would be answered late
  bool all_done = true;
  for (Cia402Axis& axis : axes_) {
    while (const auto frame = axis.sdo().next_frame(now_us())) {
      if (!line().send(*frame)) break;  // asked again after the time-out
    }
    all_done = all_done && axis.sdo().is_done();
  }
  if (all_done) finish_configuration();
}

void Cia402Bus::finish_configuration() {
  claims() = {true, true, true, true};
  for (int i = 0; i < num_axes(); ++i) {
    Cia402Axis& axis = axes_[static_cast<std::size_t>(i)];
    const auto issues = axis.sdo().issues();
    issues_.insert(issues_.end(), issues.begin(), issues.end());
    if (axis.sdo().lacks(Part::kHoldOnLoss)) claims().hold_on_loss = false;
    if (axis.sdo().lacks(Part::kTorqueLimit) || axis.sdo().lacks(Part::kTorqueActual)) {
      claims().torque_limit = false;
    }
    if (!axis.config().absolute_position) claims().absolute_position = false;
    const auto worst = std::find_if(issues.begin(), issues.end(),
                                    [](const ObjectIssue& issue) { return issue.forbids_motion; });
    if (worst != issues.end()) {
      line().raise(FaultCause::kConfiguration, i,
                   static_cast<std::uint32_t>(worst->index) << 8 | worst->subindex);
    }
  }
  if (fault_log().forbids_enabling()) {
    claims() = {};
    return enter(BusPhase::kIdle);
  }
  send_to_all(cia402::NmtCommand::kStart);
  is_starting_ = true;
  restart_phase_time();
}

void Cia402Bus::advance_starting() {
  const bool all_running = std::all_of(axes_.begin(), axes_.end(),
                                       [](const Cia402Axis& axis) { return axis.is_running(); });
  if (all_running && !fault_log().forbids_enabling()) {
    for (Cia402Axis& axis : axes_) axis.finish_configuration();
    return enter(BusPhase::kReady);
  }
  if (!is_late() && !fault_log().forbids_enabling()) return;
  for (int i = 0; i < num_axes(); ++i) {
    if (!axes_[static_cast<std::size_t>(i)].is_running()) line().raise(FaultCause::kSilent, i, 0);
  }
  claims() = {};
  enter(BusPhase::kIdle);
}

void Cia402Bus::advance_rearming() {
  const auto is_failed = [](const Cia402Axis& axis) {
    return axis.state() == DriveState::kFault || axis.state() == DriveState::kFaultReactionActive;
  };
  const bool all_configured = std::all_of(
      axes_.begin(), axes_.end(), [](const Cia402Axis& axis) { return axis.is_configured(); });
  const bool all_sound = std::all_of(axes_.begin(), axes_.end(), [&](const Cia402Axis& axis) {
    return axis.is_running() && !is_failed(axis);
  });
  if (all_configured && !all_sound && !is_late()) return;
  for (int i = 0; i < num_axes(); ++i) {
    Cia402Axis& axis = axes_[static_cast<std::size_t>(i)];
    axis.set_fault_reset(false);
    if (!axis.is_configured()) continue;
    if (!axis.is_running()) line().raise(FaultCause::kSilent, i, 0);
    if (is_failed(axis)) line().raise(FaultCause::kEnableTimeout, i, axis.status_word());
  }
  enter(all_configured ? BusPhase::kReady : BusPhase::kIdle);
}

void Cia402Bus::hold() {
  set_goal(Goal::kKeep);
  enter(BusPhase::kStopped);
}

void Cia402Bus::advance_enabling() {
  const bool all_enabled = std::all_of(axes_.begin(), axes_.end(), [](const Cia402Axis& axis) {
    return axis.state() == DriveState::kOperationEnabled;
  });
  if (fault_log().forbids_enabling()) return hold();
  if (all_enabled) return enter(BusPhase::kEnabled);
  if (!is_late()) return;
  for (int i = 0; i < num_axes(); ++i) {
    const Cia402Axis& axis = axes_[static_cast<std::size_t>(i)];
    if (axis.state() != DriveState::kOperationEnabled) {
      line().raise(FaultCause::kEnableTimeout, i, axis.status_word());
    }
  }
  hold();
}

void Cia402Bus::advance_disabling() {
  const auto is_off = [](const Cia402Axis& axis) {
    return !cia402::has_torque(axis.state()) && axis.state() != DriveState::kSwitchedOn &&
           axis.state() != DriveState::kReadyToSwitchOn;
  };
  if (std::all_of(axes_.begin(), axes_.end(), is_off)) {
    set_goal(Goal::kKeep);
    return enter(BusPhase::kReady);
  }
  if (!is_late()) return;
  for (int i = 0; i < num_axes(); ++i) {
    const Cia402Axis& axis = axes_[static_cast<std::size_t>(i)];
    if (!is_off(axis)) line().raise(FaultCause::kEnableTimeout, i, axis.status_word());
  }
  enter(BusPhase::kStopped);
}

}  // namespace can
