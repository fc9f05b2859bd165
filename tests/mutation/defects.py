# SPDX-License-Identifier: BSD-3-Clause
"""Small defects in safety and state machines, for mutation_check.

EDITS: (file, text that occurs exactly once in it, what stands there instead). DEFECT("words") in it is true only while that
defect is looked at, so that all of them live in one build. The words say what is wrong then.
"""

CLIMB = "climb_controller/climb/"
CAN = "climb_controller/can/"
SHELL = "climb_controller/"

EDITS = [
    # --- the gate before every send ---
    (CLIMB + "safety.cpp", "if (!is_finite(wanted)) return", 'if (!DEFECT("gate: not finite passes") && !is_finite(wanted)) return'),
    (CLIMB + "safety.cpp", "const double low_rad = last_rad < limits.min_rad ? last_rad : limits.min_rad;",
     'const double low_rad = DEFECT("gate: no lower limit") ? -1e9 : last_rad < limits.min_rad ? last_rad : limits.min_rad;'),
    (CLIMB + "safety.cpp", "const double high_rad = last_rad > limits.max_rad ? last_rad : limits.max_rad;",
     'const double high_rad = DEFECT("gate: 10 mrad beyond the upper limit") ? limits.max_rad + 0.01 : last_rad > limits.max_rad ? last_rad : limits.max_rad;'),
    (CLIMB + "safety.cpp", "if (!base::within(wanted.velocity_rad_s, -max_velocity, max_velocity))",
     'if (!DEFECT("gate: any velocity") && !base::within(wanted.velocity_rad_s, -max_velocity, max_velocity))'),
    (CLIMB + "safety.cpp", "const double max_step_rad = limits.max_velocity_rad_s",
     'const double max_step_rad = (DEFECT("gate: twice the step") ? 2.0 : 1.0) * limits.max_velocity_rad_s'),
    (CLIMB + "safety.cpp", "const bool is_fresh = computed_us <= now_us &&",
     'const bool is_fresh = DEFECT("gate: stale passes") ? true : computed_us <= now_us &&'),
    (CLIMB + "safety.cpp", "wanted.max_torque_Nm <= limits.max_torque_Nm;",
     '(DEFECT("gate: any torque limit") || wanted.max_torque_Nm <= limits.max_torque_Nm);'),
    (CLIMB + "safety.cpp", "if (verdict.passed()) {", 'if (DEFECT("gate: refused is taken all the same") || verdict.passed()) {'),
    (CLIMB + "safety.cpp", "if (!started_) return", 'if (!DEFECT("gate: passes before the start") && !started_) return'),
    (CLIMB + "safety.cpp", "if (!base::within(measured_rad[axis], limits.min_rad - slack_rad",
     'if (!DEFECT("gate: starts anywhere") && !base::within(measured_rad[axis], limits.min_rad - slack_rad'),
    # --- which fault does what ---
    (CLIMB + "failsafe.cpp", "const FaultFlags causes = flags & column[reaction];",
     'const FaultFlags causes = flags & column[reaction] & ~(DEFECT("failsafe: servo silent is nothing") ? flag(Fault::kServoSilent) : 0U) &\n'
     '        ~(DEFECT("failsafe: E-stop only while powered") && group_of(state) == StateGroup::kUnpowered ? flag(Fault::kEstop) : 0U);'),
    (CLIMB + "failsafe.cpp", "static_cast<Fault>(std::countr_zero(causes));",
     'static_cast<Fault>(DEFECT("failsafe: the least cause is told") ? 31 - std::countl_zero(causes) : std::countr_zero(causes));'),
    (CLIMB + "failsafe.cpp", "action.latched = action.reaction >= Reaction::kFaultHold;",
     'action.latched = action.reaction >= (DEFECT("failsafe: fault hold is not latched") ? Reaction::kEstop : Reaction::kFaultHold);'),
    (CLIMB + "failsafe.cpp", "action.silent = (flags", 'action.silent = !DEFECT("failsafe: speaks on a dead bus") && (flags'),
    (CLIMB + "failsafe.cpp", "      (flags & kMasks.close_claws) != 0", '      !DEFECT("failsafe: falls with open claws") && (flags & kMasks.close_claws) != 0'),
    # --- the controller's states ---
    (CLIMB + "controller_state.cpp", "std::optional<ControllerState> after(ControllerState state, ControllerEvent event) {",
     'std::optional<ControllerState> after(ControllerState state, ControllerEvent event) {\n'
     '  if (DEFECT("states: no fault while arming") && state == S::kArming && event == E::kFault) return std::nullopt;\n'
     '  if (DEFECT("states: no E-stop in FAULT_HOLD") && state == S::kFaultHold && event == E::kEstop) return std::nullopt;\n'
     '  if (DEFECT("states: climbs out of FAULT_HOLD") && state == S::kFaultHold && event == E::kClimb) return S::kClimbing;\n'
     '  if (DEFECT("states: reset goes to HOLD") && event == E::kReset) return S::kHold;'),
    (CLIMB + "controller.cpp", "if (command.session_id != params_.session_id) return",
     'if (!DEFECT("orders: any session") && command.session_id != params_.session_id) return'),
    (CLIMB + "controller.cpp", "if (command.seq <= last_seq_) return", 'if (!DEFECT("orders: replayed ones") && command.seq <= last_seq_) return'),
    (CLIMB + "controller.cpp", "if (!is_cleared) return false;", 'if (!DEFECT("reset: with the cause still there") && !is_cleared) return false;'),
    (CLIMB + "controller.cpp", "return in_state_s_ >= params_.reset_after_s &&",
     'return (DEFECT("reset: while it still moves") || in_state_s_ >= params_.reset_after_s) &&'),
    (CLIMB + "controller.cpp", "if (action.silent) following_ = false;",
     'if (!DEFECT("bus down: old targets return") && action.silent) following_ = false;'),
    (CLIMB + "controller.cpp", "        reason_ = before;", '        reason_ = DEFECT("reason: a later one wins") ? action.reason : before;'),
    (CLIMB + "controller.cpp", "return action_.reaction == Reaction::kNothing && take(E::kArm);",
     'return (DEFECT("arming: in spite of a fault") || action_.reaction == Reaction::kNothing) && take(E::kArm);'),
    (CLIMB + "controller.cpp", "if (hangs_ && !parks && !params_.power_off_holds) return false;",
     'if (!DEFECT("disarm: hanging without brakes") && hangs_ && !parks && !params_.power_off_holds) return false;'),
    (CLIMB + "controller.cpp", "if (ahead > (finishes", 'if (!DEFECT("climb: in spite of a fault") && ahead > (finishes'),
    (CLIMB + "controller_output.cpp", "      return DriveRequest::kQuickStop;",
     '      return DEFECT("E-stop: drives are not told") ? DriveRequest::kNone : DriveRequest::kQuickStop;'),
    (CLIMB + "controller_output.cpp", "if (other != leg && !holds) limb.others_hold = false;",
     'if (!DEFECT("release: the others are not asked") && other != leg && !holds) limb.others_hold = false;'),
    (CLIMB + "controller_output.cpp", "if (!verdict_.passed()) unsafe_ = true;",
     'if (!DEFECT("gate: its refusal is no fault") && !verdict_.passed()) unsafe_ = true;'),
    (CLIMB + "controller_work.cpp", "if (began_now_) return true;", 'if (!DEFECT("arming: moves with the first target") && began_now_) return true;'),
    (CLIMB + "controller_work.cpp", "if (!is_confirmed(limbs_[leg].state()) || !limbs_[leg].confirmation().holds()) return false;",
     'if (!DEFECT("lifting: from an infirm stance") && (!is_confirmed(limbs_[leg].state()) || !limbs_[leg].confirmation().holds())) return false;'),
    (CLIMB + "controller_work.cpp", "return !(state_ == S::kProtectiveHold && is_at_rung);",
     'return !DEFECT("stop: the limb goes on") && !(state_ == S::kProtectiveHold && is_at_rung);'),
    (CLIMB + "controller_work.cpp", "if (hangs_ && num_closed > 0 && num_closed < 3) {",
     'if (!DEFECT("arming: hanging on two claws") && hangs_ && num_closed > 0 && num_closed < 3) {'),
    (CLIMB + "controller_work.cpp", "if (following_ && !input.drives_enabled) following_ = false;",
     'if (!DEFECT("drives that stopped are followed up") && following_ && !input.drives_enabled) following_ = false;'),
    (CLIMB + "controller_stance.cpp", "if (num_held >= 3) return false;",
     'if (num_held >= (DEFECT("fall alarm: two claws are enough") ? 2 : 3)) return false;'),
    (CLIMB + "controller_stance.cpp", "return !(borne_N <=", 'return !DEFECT("dock: opens claws that bear the body") && !(borne_N <='),
    # --- one limb ---
    (CLIMB + "grasp_confirmation.cpp", "witness.touch = touch_s_", 'witness.touch = DEFECT("grasp: without touch") || touch_s_'),
    (CLIMB + "grasp_confirmation.cpp", "witness.jaw = in_window();", 'witness.jaw = DEFECT("grasp: any jaw angle") || in_window();'),
    (CLIMB + "grasp_confirmation.cpp", "witness.torque = std::abs", 'witness.torque = DEFECT("grasp: without torque") || std::abs'),
    (CLIMB + "grasp_confirmation.cpp", "verdict.pull = std::abs(pull.slip_m) <", 'verdict.pull = DEFECT("grasp: slips") ? true : std::abs(pull.slip_m) <'),
    (CLIMB + "grasp_confirmation.cpp", "num_disagreements_ = agree ? 0 :",
     'num_disagreements_ = agree || DEFECT("grasp: contradictions do not count") ? 0 :'),
    (CLIMB + "limb_cycle.cpp", "if (arrived && input.others_hold)",
     'if (arrived && (DEFECT("release: although the others do not hold") || input.others_hold))'),
    (CLIMB + "limb_cycle.cpp", "else if (num_tries_ < max_tries)", 'else if (DEFECT("regrasp: for ever") || num_tries_ < max_tries)'),
    (CLIMB + "limb_state.cpp", "std::optional<LimbState> after(LimbState state, LimbEvent event) {",
     'std::optional<LimbState> after(LimbState state, LimbEvent event) {\n'
     '  if (DEFECT("limb: loaded without a pull test") && state == S::kClosing && event == E::kDone) return S::kLoading;\n'
     '  if (DEFECT("limb: a lost stance is not told") && state == S::kLoaded && event == E::kLost) return std::nullopt;\n'
     '  if (DEFECT("limb: no way back") && state == S::kTransit && event == E::kAbort) return std::nullopt;'),
    # --- what is watched ---
    (CLIMB + "fault_watch.cpp", "if (!axis.valid || !std::isfinite(axis.position_rad))",
     'if ((!DEFECT("watch: silent axes") && !axis.valid) || !std::isfinite(axis.position_rad))'),
    (CLIMB + "fault_watch.cpp", "if (num_behind_[axis] >= kMaxBehind)", 'if (!DEFECT("watch: axes that do not follow") && num_behind_[axis] >= kMaxBehind)'),
    (CLIMB + "fault_watch.cpp", "if (!(step_rad <= max_step_rad))", 'if (!DEFECT("watch: jumps") && !(step_rad <= max_step_rad))'),
    (CLIMB + "fault_watch.cpp", "if (falling_s_ >= params_.free_fall_s - 1e-6)", 'if (!DEFECT("watch: free fall") && falling_s_ >= params_.free_fall_s - 1e-6)'),
    (CLIMB + "fault_watch.cpp", "if (armed_ && !upright)", 'if (!DEFECT("watch: tilt") && armed_ && !upright)'),
    (CLIMB + "fault_watch.cpp", "const bool sees = age_us >= 0 && age_us <=", 'const bool sees = DEFECT("watch: old rungs") ? true : age_us >= 0 && age_us <='),
    (CLIMB + "support.cpp", "  remaining.contacts[lifted].weight = 0.0;", '  if (!DEFECT("support: with the lifted limb")) remaining.contacts[lifted].weight = 0.0;'),
    (CLIMB + "support.cpp", "verdict.burden = verdict.margin >= 1.0 ?", 'verdict.burden = verdict.margin >= (DEFECT("support: half the margin") ? 0.5 : 1.0) ?'),
    # --- the bus ---
    (CAN + "cia402_axis.cpp", "if (goal_ == Goal::kKeep && is_silent &&", 'if (!DEFECT("bus: 0Fh to a silent drive") && goal_ == Goal::kKeep && is_silent &&'),
    (CAN + "cia402_axis.cpp", "if (goal_ == Goal::kKeep && state_ == DriveState::kQuickStopActive)",
     'if (!DEFECT("bus: 0Fh and 0Bh in turns") && goal_ == Goal::kKeep && state_ == DriveState::kQuickStopActive)'),
    (CAN + "cia402_axis.cpp", "if (goal == Goal::kEnabled && is_broken_)", 'if (!DEFECT("bus: a broken axis is enabled") && goal == Goal::kEnabled && is_broken_)'),
    (CAN + "cia402_axis.cpp", "if (!has_status_ || state_ != DriveState::kOperationEnabled) command_.counts",
     'if (!DEFECT("bus: the first target is an old one") && (!has_status_ || state_ != DriveState::kOperationEnabled)) command_.counts'),
    (CAN + "cia402_axis.cpp", "if (!is_expected) raise", 'if (!DEFECT("bus: a restart is nothing") && !is_expected) raise'),
    (CAN + "cia402_axis.cpp", "if (num_missed_ >= params.max_missed_cycles)", 'if (!DEFECT("bus: missed states") && num_missed_ >= params.max_missed_cycles)'),
    (CAN + "cia402_bus.cpp", "  if (was_away) {", '  if (!DEFECT("bus: a pause is not asked after") && was_away) {'),
    (CAN + "cia402_bus.cpp", "if (cia402::is_master_frame(frame)) {", 'if (!DEFECT("bus: a second master") && cia402::is_master_frame(frame)) {'),
    (CAN + "phased_bus.cpp", "if (all_sound) accept_offered();", 'if (DEFECT("bus: half a cycle of targets") || all_sound) accept_offered();'),
    (CAN + "phased_bus.cpp", "if (!(age_us >= 0 && age_us <= 2 * cycle_us_)) {", 'if (!DEFECT("bus: old targets") && !(age_us >= 0 && age_us <= 2 * cycle_us_)) {'),
    (CAN + "bus_line.cpp", "if (unsent_us < max_us) return;", 'if (DEFECT("line: late requests") || unsent_us < max_us) return;'),
    (CAN + "bus_line.cpp", "bool BusLine::send(const CanFrame& frame) {\n  if (is_faulted_) return false;",
     'bool BusLine::send(const CanFrame& frame) {\n  if (!DEFECT("line: sends over a fault") && is_faulted_) return false;'),
    (CAN + "bus_line.cpp", "if (is_first && is_usable_ && transport_.has_unsent_frames())",
     'if (!DEFECT("line: purges nothing") && is_first && is_usable_ && transport_.has_unsent_frames())'),
    (CAN + "odrive_bus.cpp", "  if (was_away) {", '  if (!DEFECT("ODrive: a pause is not asked after") && was_away) {'),
    # --- the shell ---
    (SHELL + "bus_walk.cpp", "if (is_powering && !has_targets)",
     'if ((DEFECT("walk: enabling goes on unasked") ? phase == BusPhase::kEnabled : is_powering) && !has_targets)'),
    (SHELL + "control_cycle.cpp", "if (inbox.lines.lost) input_.faults", 'if (!DEFECT("cycle: lost lines") && inbox.lines.lost) input_.faults'),
    (SHELL + "control_cycle.cpp", "if (!can.hold_on_loss) return", 'if (!DEFECT("cycle: drives that go limp") && !can.hold_on_loss) return'),
    (SHELL + "control_cycle.cpp", "if (!stands) return false;", 'if (!DEFECT("cycle: a reset cuts targets off") && !stands) return false;'),
    (SHELL + "control_cycle.cpp", "if (command.session_id != session_id()) return", 'if (!DEFECT("cycle: any session") && command.session_id != session_id()) return'),
]
