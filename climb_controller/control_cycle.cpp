// SPDX-License-Identifier: BSD-3-Clause
#include "climb_controller/control_cycle.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/check.h"
#include "climb_controller/fault_map.h"

namespace climb_controller {
namespace {

using climb::CommandVerdict;
using climb::Order;

constexpr int kMaxSilentCycles = 2;  // a reading counts so long after it was heard

climb::ControllerParams completed(const CycleParams& params) {
  climb::ControllerParams controller = params.controller;
  controller.power_off_holds = params.power_off_hold != PowerOffHold::kNone;
  controller.on_ladder = !params.allow_no_hold_on_loss;
  return controller;
}

}  // namespace

const char* name(Policy policy) {
  switch (policy) {
    case Policy::kNone:
      return "none";
    case Policy::kNoHoldOnLoss:
      return "a drive would not hold by itself when the controller is gone";
    case Policy::kNoTorqueLimit:
      return "a drive neither limits nor measures torque";
    case Policy::kGroundTest:
      return "allow_no_hold_on_loss is for ground tests: it never climbs";
    case Policy::kNoPowerOffHold:
      return "power_off_hold is none: it never leaves the ground";
  }
  return "?";
}

bool finishes_first(climb::ControllerState state) {
  return state == climb::ControllerState::kClimbing ||
         state == climb::ControllerState::kProtectiveHold;
}

std::string check(const CycleParams& params) {
  const std::string violated = climb::check(completed(params));
  if (!violated.empty()) return violated;
  if (!(params.walk.bring_up_period_us > 0)) return "walk.bring_up_period_us must be > 0";
  if (!(params.walk.reset_timeout_us > 0)) return "walk.reset_timeout_us must be > 0";
  return "";
}

ControlCycle::ControlCycle(const CycleParams& params, can::ServoBus& bus)
    : params_(params), bus_(bus), walk_(params.walk, bus), controller_(completed(params)) {
  CHECK(check(params).empty(), "parameters must be checked before");
  CHECK(bus.num_axes() == climb::kNumAxes, "four legs of four axes");
  silent_cycles_.fill(kMaxSilentCycles + 1);
}

void ControlCycle::step(std::int64_t now_us, const CycleInbox& inbox,
                        CycleReport& report) noexcept {
  now_us_ = now_us;
  bus_.begin_cycle(now_us, feedback_);
  // Drives that leave their state because they were told to are no fault.
  if (!has_handed_over_) control(inbox);
  send();
  report.lines = inbox.lines;
  fill(report);
}

void ControlCycle::control(const CycleInbox& inbox) {
  walk_.step(now_us_, controller_.state() == climb::ControllerState::kBoot);
  read(inbox);
  input_.command = order_of(inbox);
  controller_.step(input_, output_);
  if (input_.command.order != Order::kNone) answer(input_.command, output_.command);
  walk_.obey(output_.drives, output_.send);
}

void ControlCycle::hand_over() noexcept {
  bus_.stop(can::StopKind::kQuickStop);
  has_handed_over_ = true;
  output_.send = false;
}

void ControlCycle::read(const CycleInbox& inbox) {
  for (int axis = 0; axis < climb::kNumAxes; ++axis) {
    const can::AxisFeedback& heard = feedback_[axis];
    silent_cycles_[axis] = heard.fresh ? 0 : std::min(silent_cycles_[axis], 1000) + 1;
    climb::AxisReading& reading = input_.axes[axis];
    // A drive that restarts has no position from that moment: what it said last still counts, so
    // that the restart is the reason told, not its silence.
    if (std::isfinite(heard.position_rad)) reading.position_rad = heard.position_rad;
    // A drive without torque measurement bears nothing that could confirm a grasp.
    reading.torque_Nm = std::isfinite(heard.torque_Nm) ? heard.torque_Nm : 0.0;
    reading.valid = silent_cycles_[axis] <= kMaxSilentCycles;
  }
  input_.now_us = now_us_;
  input_.imu = inbox.imu;
  input_.ladder = inbox.ladder;
  input_.ladder_received_us = inbox.ladder_received_us;
  input_.drives_enabled = walk_.follows_targets();
  input_.drives_ready = walk_.is_configured() && bus_.faults().empty();
  input_.faults = inbox.faults | flags_of(bus_.faults());
  if (policy_of_drives() != Policy::kNone)
    input_.faults |= climb::flag(climb::Fault::kConfiguration);
  // Lines that cannot be read are a fault of their own, with the same reaction as the E-stop.
  if (inbox.lines.lost) input_.faults |= climb::flag(climb::Fault::kLinesLost);
  input_.estop_clear = inbox.lines.lost || inbox.lines.estop_clear;
  for (const climb::Leg leg : climb::kLegs) {
    input_.touch[leg] = !inbox.lines.lost && inbox.lines.touch[leg];
  }
}

// --- orders --------------------------------------------------------------------------------------

/// What the controller is told to do in this cycle.
climb::OperatorCommand ControlCycle::order_of(const CycleInbox& inbox) {
  const climb::OperatorCommand& command = inbox.command;
  if (command.order != Order::kNone) {
    policy_ = Policy::kNone;
    const CommandVerdict verdict = judge(command);
    if (verdict != CommandVerdict::kAccepted) {
      answer(command, verdict);
    } else if (command.order == Order::kReset && may_reset_bus(inbox.lines)) {
      waiting_ = command;
      walk_.begin_reset(now_us_);
    } else {
      return command;
    }
  }
  if (walk_.is_resetting()) return {};
  return std::exchange(waiting_, {});
}

bool ControlCycle::may_reset_bus(const LineLevels& lines) const {
  // Drives that follow targets would lose them: only what has stopped may be reset.
  using S = climb::ControllerState;
  const S at = controller_.state();
  const bool stands = is_latched(at) || at == S::kBoot || at == S::kSelftest || at == S::kDisarmed;
  if (!stands) return false;
  const bool needs_it = !bus_.faults().empty() || !walk_.is_configured();
  return needs_it && lines.estop_clear && !lines.lost;
}

CommandVerdict ControlCycle::judge(const climb::OperatorCommand& command) {
  if (command.session_id != session_id()) return CommandVerdict::kWrongSession;
  if (command.seq <= last_seq_) return CommandVerdict::kReplayed;
  last_seq_ = command.seq;
  policy_ = policy_against(command.order);
  const bool may = policy_ == Policy::kNone && waiting_.order == Order::kNone;
  return may ? CommandVerdict::kAccepted : CommandVerdict::kNotNow;
}

void ControlCycle::answer(const climb::OperatorCommand& command, CommandVerdict verdict) {
  answered_ = command;
  // A stranger's number is not repeated: the next order continues ours.
  if (verdict == CommandVerdict::kWrongSession) answered_.seq = last_seq_;
  verdict_ = verdict;
  ++num_answers_;
}

Policy ControlCycle::policy_of_drives() const {
  if (params_.allow_no_hold_on_loss || !walk_.is_configured()) return Policy::kNone;
  const can::Capabilities can = bus_.capabilities();
  if (!can.hold_on_loss) return Policy::kNoHoldOnLoss;
  return can.torque_limit ? Policy::kNone : Policy::kNoTorqueLimit;
}

Policy ControlCycle::policy_against(Order order) const {
  if (order == Order::kArm) return policy_of_drives();
  if (order != Order::kClimb && order != Order::kClimbDown) return Policy::kNone;
  if (params_.allow_no_hold_on_loss) return Policy::kGroundTest;
  const bool may_leave_ground = params_.power_off_hold != PowerOffHold::kNone;
  return may_leave_ground ? Policy::kNone : Policy::kNoPowerOffHold;
}

// --- out -----------------------------------------------------------------------------------------

void ControlCycle::send() {
  can::Targets targets;
  targets.time_us = now_us_;
  if (output_.send) {
    for (int axis = 0; axis < climb::kNumAxes; ++axis) {
      const climb::AxisCommand& command = output_.axes[axis];
      targets_[axis] = {command.position_rad, command.velocity_rad_s, command.torque_Nm,
                        command.max_torque_Nm};
    }
    targets.axes = targets_;
  }
  bus_.end_cycle(targets);
}

void ControlCycle::fill(CycleReport& report) const {
  report.now_us = now_us_;
  report.output = output_;
  report.faults = input_.faults;
  report.bus_phase = bus_.phase();
  report.axes = feedback_;
  report.bus_faults.assign(bus_.faults());
  report.issues.assign(bus_.issues());
  report.policy = policy_;
  report.order = answered_.order;
  report.order_seq = answered_.seq;
  report.verdict = verdict_;
  report.num_answers = num_answers_;
  report.is_resetting = walk_.is_resetting();
}

}  // namespace climb_controller
