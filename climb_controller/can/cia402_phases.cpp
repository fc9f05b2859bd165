// SPDX-License-Identifier: BSD-3-Clause
// How Cia402Bus goes from phase to phase.
#include <algorithm>

#include "can/cia402_bus.h"

namespace can {

using cia402::Goal;

void Cia402Bus::enter(BusPhase phase) {
  phase_ = phase;
  has_phase_begun_ = false;  // begins at the next poll, which knows the time
}

bool Cia402Bus::is_late() const {
  return now_us_ - phase_since_us_ > params_.walk_timeout_us;
}

bool Cia402Bus::is_cycling() const {
  switch (phase_) {
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
  has_phase_begun_ = true;
  phase_since_us_ = now_us_;
  if (recorder_ != nullptr) recorder_->record(now_us_, phase_);
  switch (phase_) {
    case BusPhase::kListening:
      line_.clear();
      break;
    case BusPhase::kConfiguring:
      is_starting_ = false;
      capabilities_ = {};
      issues_.clear();
      send_to_all(cia402::NmtCommand::kEnterPreOperational);
      for (Cia402Axis& axis : axes_) axis.begin_configuration(now_us_);
      break;
    case BusPhase::kRearming:
      faults_.clear();  // what the drives said while the bus only listened is about the past
      for (Cia402Axis& axis : axes_) {
        axis.forget(now_us_);
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

void Cia402Bus::advance() {
  const bool is_clearing = phase_ == BusPhase::kListening && !has_phase_begun_;
  if (line_.is_faulted() && phase_ != BusPhase::kFaulted && !is_clearing) {
    enter(BusPhase::kFaulted);
  }
  if (!has_phase_begun_) begin_phase();
  switch (phase_) {
    case BusPhase::kListening:
      if (line_.is_faulted()) return enter(BusPhase::kFaulted);
      if (!is_speaking_ && now_us_ - phase_since_us_ < params_.listen_us) return;
      is_speaking_ = true;
      enter(after_listening_);
      begin_phase();
      break;
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
  bool all_done = true;
  for (Cia402Axis& axis : axes_) {
    while (const auto frame = axis.sdo().next_frame(now_us_)) {
      if (!line_.send(*frame)) break;  // asked again after the time-out
    }
    all_done = all_done && axis.sdo().is_done();
  }
  if (all_done) finish_configuration();
}

void Cia402Bus::finish_configuration() {
  capabilities_ = {true, true, true, true};
  for (int i = 0; i < num_axes(); ++i) {
    Cia402Axis& axis = axes_[static_cast<std::size_t>(i)];
    const auto issues = axis.sdo().issues();
    issues_.insert(issues_.end(), issues.begin(), issues.end());
    if (axis.sdo().lacks_hold_on_loss()) capabilities_.hold_on_loss = false;
    if (!axis.config().has_torque) capabilities_.torque_limit = false;
    if (!axis.config().absolute_position) capabilities_.absolute_position = false;
    const auto worst = std::find_if(issues.begin(), issues.end(),
                                    [](const ObjectIssue& issue) { return issue.forbids_motion; });
    if (worst != issues.end()) {
      line_.raise(FaultCause::kConfiguration, i,
                  static_cast<std::uint32_t>(worst->index) << 8 | worst->subindex);
    }
  }
  if (faults_.forbids_enabling()) {
    capabilities_ = {};
    return enter(BusPhase::kIdle);
  }
  send_to_all(cia402::NmtCommand::kStart);
  is_starting_ = true;
  phase_since_us_ = now_us_;
}

void Cia402Bus::advance_starting() {
  const bool all_running = std::all_of(axes_.begin(), axes_.end(),
                                       [](const Cia402Axis& axis) { return axis.is_running(); });
  if (all_running && !faults_.forbids_enabling()) {
    for (Cia402Axis& axis : axes_) axis.finish_configuration();
    return enter(BusPhase::kReady);
  }
  if (!is_late() && !faults_.forbids_enabling()) return;
  for (int i = 0; i < num_axes(); ++i) {
    if (!axes_[static_cast<std::size_t>(i)].is_running()) line_.raise(FaultCause::kSilent, i, 0);
  }
  capabilities_ = {};
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
    if (!axis.is_running()) line_.raise(FaultCause::kSilent, i, 0);
    if (is_failed(axis)) line_.raise(FaultCause::kEnableTimeout, i, axis.status_word());
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
  if (faults_.forbids_enabling()) return hold();
  if (all_enabled) return enter(BusPhase::kEnabled);
  if (!is_late()) return;
  for (int i = 0; i < num_axes(); ++i) {
    const Cia402Axis& axis = axes_[static_cast<std::size_t>(i)];
    if (axis.state() != DriveState::kOperationEnabled) {
      line_.raise(FaultCause::kEnableTimeout, i, axis.status_word());
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
    if (!is_off(axis)) line_.raise(FaultCause::kEnableTimeout, i, axis.status_word());
  }
  enter(BusPhase::kStopped);
}

}  // namespace can
