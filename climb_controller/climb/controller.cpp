// SPDX-License-Identifier: BSD-3-Clause
#include "climb/controller.h"

#include "base/check.h"

namespace climb {

using S = ControllerState;

namespace {
using E = ControllerEvent;

/// Judgements on what was going on: with the reset they are over, and arming looks anew.
constexpr FaultFlags kForgottenByReset = flag(Fault::kStanceLost) | flag(Fault::kTooFewGrasps) |
                                         flag(Fault::kUnsafeCommand) | flag(Fault::kNoGrasp) |
                                         flag(Fault::kGraspDisagrees) | flag(Fault::kTracking);

std::array<LimbCycle, kNumLegs> limbs_of(const ControllerParams& p) {
  const auto limb = [&p](Leg leg) {
    return LimbCycle(p.climb.robot, p.climb.motion, p.limb, p.confirmation, leg);
  };
  return {limb(kFrontLeft), limb(kFrontRight), limb(kRearLeft), limb(kRearRight)};
}

}  // namespace

std::string check(const ControllerParams& p) {
  std::string violated = check(p.climb);
  if (violated.empty()) violated = check(p.confirmation);
  if (violated.empty()) violated = check(p.limb);
  if (violated.empty()) violated = check(p.watch);
  if (violated.empty()) violated = check(axis_limits(p.climb.robot));
  if (!violated.empty()) return violated;
  if (p.session_id == 0) return "session_id must not be 0";
  if (!(p.gate.period_s == p.climb.motion.period_s && p.watch.period_s == p.gate.period_s)) {
    return "gate.period_s and watch.period_s must be motion.period_s";
  }
  if (!(p.max_sag_m > 0.0 && p.max_sag_m <= 1.0)) return "max_sag_m must be above 0, at most 1";
  if (!(p.max_borne_part > 0.0 && p.max_borne_part < 1.0)) {
    return "max_borne_part must be above 0, below 1";
  }
  if (!(p.torque_ramp_s >= 0.01)) return "torque_ramp_s must be 0.01 or more";
  const double times_s[] = {p.selftest_s,       p.enable_timeout_s, p.dock_timeout_s,
                            p.put_down_after_s, p.torque_ramp_s,    p.reset_after_s,
                            p.look_again_s};
  for (const double time_s : times_s) {
    if (!(time_s >= 0.0 && time_s <= 3600.0)) {
      return "selftest_s, enable_timeout_s, dock_timeout_s, put_down_after_s, torque_ramp_s, "
             "reset_after_s and look_again_s must be 0..3600";
    }
  }
  return "";
}

Controller::Controller(const ControllerParams& params)
    : params_(params),
      limits_(axis_limits(params.climb.robot)),
      gate_(limits_, params.gate),
      watch_(limits_, params.watch),
      planner_(params.climb),
      way_back_(params.climb),
      shift_(params.climb.robot, params.climb.motion),
      odometry_(params.climb.robot, params.climb.odometry),
      support_(params.climb.robot, params.climb.support),
      kinematics_(params.climb.robot),
      limbs_(limbs_of(params)) {
  CHECK(check(params).empty(), "parameters must be checked before");
}

void Controller::step(const ControllerInput& input, ControllerOutput& output) {
  in_state_s_ += params_.gate.period_s;
  began_now_ = false;
  if (is_sound(input.imu)) q_odom_body_ = input.imu.q_odom_body.normalized();
  faults_ = faults_of(input);
  action_ = failsafe(faults_, state_);
  react(action_);
  output.command = take_command(input.command);
  update_pose(input);
  work(input);
  weigh_grips(input);
  at_dock_ = planner_.is_at_dock(robot_now(input));
  send(input, output);
  output.drives = drive_request(input);
  report(output);
}

FaultFlags Controller::faults_of(const ControllerInput& input) {
  FaultFlags faults = watch_.look(input, gate_.sent());
  for (const Leg leg : kLegs) {
    const LimbCycle& limb = limbs_[leg];
    if (limb.confirmation().is_touch_stuck()) faults |= flag(Fault::kTouchStuck);
    if (!following_) continue;
    if (limb.confirmation().disagrees()) faults |= flag(Fault::kGraspDisagrees);
    if (limb.failed()) faults |= flag(Fault::kNoGrasp);
    if (limb.state() == LimbState::kSupportLost) faults |= flag(Fault::kStanceLost);
  }
  if (lacks_grasps()) faults |= flag(Fault::kTooFewGrasps);
  if (is_stuck_) faults |= flag(Fault::kTracking);
  const bool dropped_out = following_ && !input.drives_enabled && state_ != S::kDisarming;
  // What made the bus stop its drives is the reason, where it is told.
  const bool is_told = failsafe(input.faults, state_).reaction >= Reaction::kFaultHold;
  if (dropped_out && !is_told) faults |= flag(Fault::kServoState);
  if (unsafe_) faults |= flag(Fault::kUnsafeCommand);
  return faults;
}

void Controller::react(const Action& action) {
  if (action.silent) following_ = false;  // and never again without arming: no old target returns
  const Fault before = reason_;
  if (action.reaction != Reaction::kNothing && !is_latched(state_)) reason_ = action.reason;
  switch (action.reaction) {
    case Reaction::kNothing:
      if (state_ == S::kProtectiveHold) take(E::kRecovered);
      if (!is_latched(state_)) reason_ = Fault::kNone;
      return;
    case Reaction::kBlock:
      if (state_ == S::kArming) take(E::kArmingRefused);
      return;
    case Reaction::kFinishStep:
      ending_ = Ending::kNow;
      if (state_ == S::kProtectiveHold) take(E::kRecovered);
      return;
    case Reaction::kProtectiveHold:
      take(E::kProtect);
      return;
    case Reaction::kFaultHold:
      take(E::kFault);
      return;
    case Reaction::kEstop:
      if (take(E::kEstop))
        reason_ = action.reason;
      else
        reason_ = before;
      return;
  }
}

CommandVerdict Controller::take_command(const OperatorCommand& command) {
  if (command.order == Order::kNone) return CommandVerdict::kNone;
  if (command.session_id != params_.session_id) return CommandVerdict::kWrongSession;
  if (command.seq <= last_seq_) return CommandVerdict::kReplayed;
  last_seq_ = command.seq;
  return obey(command.order) ? CommandVerdict::kAccepted : CommandVerdict::kNotNow;
}

bool Controller::obey_climb(bool upwards) {
  // Of what would stop it at once nothing may be there; a step in the air may be finished.
  const Reaction ahead = failsafe(faults_, S::kClimbing).reaction;
  const bool finishes = state_ == S::kPaused && is_under_way();
  if (ahead > (finishes ? Reaction::kFinishStep : Reaction::kNothing)) return false;
  if (finishes && upwards != upwards_) return false;
  if (!take(E::kClimb)) return false;
  upwards_ = upwards;
  if (!finishes) {
    planner_.forget_vain();
    num_withdrawn_ = 0;
    steps_over_ = false;
  }
  ending_ = ahead == Reaction::kNothing ? Ending::kNone : Ending::kNow;
  return true;
}

bool Controller::obey_hold() {
  // HOLD is a place to rest in: a step in the air is finished first and, ordered once, the steps
  // to a stance that stands any one rung's loss.
  const bool is_resting = !is_under_way();
  switch (state_) {
    case S::kArming:
      return take(E::kArmingRefused);
    case S::kClimbing:
      ending_ = ending_ == Ending::kNone ? Ending::kAtRest : Ending::kNow;
      num_steps_to_rest_ = 0;
      return true;
    case S::kPaused:
      if (is_resting) return take(E::kHold);
      if (!obey_climb(upwards_)) return false;
      ending_ = Ending::kNow;
      return true;
    case S::kProtectiveHold:
      if (is_resting) return take(E::kHold);
      ending_ = Ending::kNow;
      return true;
    default:
      return false;
  }
}

bool Controller::obey_reset() {
  const bool is_cleared = (faults_ & forbidding_reset() & ~kForgottenByReset) == 0;
  if (!is_cleared) return false;
  // Without power nothing is latched here, but a reset has brought the bus back.
  if (group_of(state_) == StateGroup::kUnpowered) return true;
  if (putting_down_) return false;
  return in_state_s_ >= params_.reset_after_s && take(E::kReset);
}

bool Controller::obey_disarm() {
  // Ordered at the dock's place it is the word that the dock is there; that is tried first.
  const bool parks = hangs_ && at_dock_;
  if (hangs_ && !parks && !params_.power_off_holds) return false;
  if (!take(E::kDisarm)) return false;
  parking_ = parks;
  parked_.reset();
  T_odom_body_before_ = odometry_.estimate().T_odom_body();
  return true;
}

bool Controller::obey(Order order) {
  switch (order) {
    case Order::kNone:
      return false;
    case Order::kArm:
      return action_.reaction == Reaction::kNothing && take(E::kArm);
    case Order::kClimb:
    case Order::kClimbDown:
      return obey_climb(order == Order::kClimb);
    case Order::kPause:
      return take(E::kPause);
    case Order::kHold:
      return obey_hold();
    case Order::kReset:
      return obey_reset();
    case Order::kDisarm:
      if (state_ == S::kArming) return take(E::kArmingRefused);
      return obey_disarm();
  }
  return false;
}

bool Controller::take(ControllerEvent event) {
  const std::optional<ControllerState> next = after(state_, event);
  if (!next) return false;
  state_ = *next;
  in_state_s_ = looked_s_ = 0.0;
  forget_other_way();
  if (state_ == S::kHold || state_ == S::kDisarmed) ending_ = Ending::kNone;
  if (state_ == S::kDisarmed || state_ == S::kEstop) {
    following_ = false;
    gate_.stop();
    watch_.disarm();
    shift_.cancel();
    num_shifts_ = 0;
    stepping_ = false;
    unsafe_ = false;
    putting_down_.reset();
    put_down_vain_ = false;
  }
  if (state_ != S::kDisarming) parking_ = is_stuck_ = false;
  return true;
}

}  // namespace climb
