// SPDX-License-Identifier: BSD-3-Clause
#include "climb/controller.h"

#include <algorithm>

#include "base/check.h"

namespace climb {
namespace {

using S = ControllerState;
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
  if (violated.empty()) violated = check(axis_limits(p.climb.robot));
  if (!violated.empty()) return violated;
  if (p.session_id == 0) return "session_id must not be 0";
  if (!(p.gate.period_s == p.climb.motion.period_s && p.watch.period_s == p.gate.period_s)) {
    return "gate.period_s and watch.period_s must be motion.period_s";
  }
  return "";
}

Controller::Controller(const ControllerParams& params)
    : params_(params),
      limits_(axis_limits(params.climb.robot)),
      gate_(limits_, params.gate),
      watch_(limits_, params.watch),
      planner_(params.climb),
      shift_(params.climb.robot, params.climb.motion),
      odometry_(params.climb.robot, params.climb.odometry),
      support_(params.climb.robot, params.climb.support),
      limbs_(limbs_of(params)) {
  CHECK(check(params).empty(), "parameters must be checked before");
}

void Controller::step(const ControllerInput& input, ControllerOutput& output) {
  in_state_s_ += params_.gate.period_s;
  faults_ = faults_of(input);
  action_ = failsafe(faults_, state_);
  react(action_);
  output.command = take_command(input.command);
  update_pose(input);
  work(input);
  send(input, output);
  output.drives = drive_request(input);
  report(output);
}

FaultFlags Controller::faults_of(const ControllerInput& input) {
  FaultFlags faults = watch_.look(input, gate_.sent());
  int num_held = 0;
  for (const Leg leg : kLegs) {
    const LimbCycle& limb = limbs_[leg];
    if (limb.confirmation().is_touch_stuck()) faults |= flag(Fault::kTouchStuck);
    if (!following_) continue;
    if (limb.confirmation().disagrees()) faults |= flag(Fault::kGraspDisagrees);
    if (limb.failed()) faults |= flag(Fault::kNoGrasp);
    if (limb.state() == LimbState::kSupportLost) faults |= flag(Fault::kStanceLost);
    num_held += limb.state() == LimbState::kLoaded ? 1 : 0;
  }
  const bool few = following_ && was_docked_ && params_.on_ladder && num_held < 3;
  if (few) faults |= flag(Fault::kTooFewGrasps);
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
      finishing_ = true;
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

bool Controller::obey(Order order) {
  switch (order) {
    case Order::kNone:
      return false;
    case Order::kArm:
      return action_.reaction == Reaction::kNothing && take(E::kArm);
    case Order::kClimb:
    case Order::kClimbDown: {
      const bool may = state_ != S::kPaused || (order == Order::kClimb) == upwards_;
      if (finishing_ || !may || !take(E::kClimb)) return false;
      upwards_ = order == Order::kClimb;
      return true;
    }
    case Order::kPause:
      return take(E::kPause);
    case Order::kHold:
      // HOLD is a place to rest in: a step in the air is finished first.
      if (state_ == S::kClimbing) return finishing_ = true;
      return moving_limb() == nullptr && take(E::kHold);
    case Order::kReset:
      if ((faults_ & forbidding_reset() & ~kForgottenByReset) != 0) return false;
      // Without power nothing is latched here, but a reset has brought the bus back.
      return group_of(state_) == StateGroup::kUnpowered || take(E::kReset);
    case Order::kDisarm:
      return (!was_docked_ || params_.power_off_holds) && take(E::kDisarm);
  }
  return false;
}

bool Controller::take(ControllerEvent event) {
  const std::optional<ControllerState> next = after(state_, event);
  if (!next) return false;
  state_ = *next;
  in_state_s_ = 0.0;
  if (state_ == S::kHold || state_ == S::kDisarmed) finishing_ = false;
  if (state_ == S::kDisarmed || state_ == S::kEstop) {
    following_ = false;
    gate_.stop();
    watch_.disarm();
    shift_.cancel();
    shifted_ = false;
    unsafe_ = false;
  }
  return true;
}

void Controller::work(const ControllerInput& input) {
  if (following_ && !input.drives_enabled) following_ = false;  // the drives hold by themselves
  boot(input);
  if (state_ == S::kArming) work_arming(input);
  if (state_ == S::kClimbing) work_climbing(input);
  move(input);
  const bool is_down = !input.drives_enabled && in_state_s_ > params_.gate.period_s;
  if (state_ == S::kDisarming && is_down) take(E::kDisarmed);
}

void Controller::boot(const ControllerInput& input) {
  const bool heard = (faults_ & flag(Fault::kServoSilent)) == 0 && input.imu.valid;
  if (state_ == S::kBoot && heard) take(E::kBooted);
  if (state_ != S::kSelftest) return;
  if (action_.reaction != Reaction::kNothing) in_state_s_ = 0.0;
  if (in_state_s_ >= params_.selftest_s) take(E::kSelftestPassed);
}

void Controller::work_arming(const ControllerInput& input) {
  if (!following_) {
    if (input.drives_enabled)
      start_following(input);
    else if (in_state_s_ > params_.enable_timeout_s)
      take(E::kArmingRefused);
    return;
  }
  if (moving_limb() != nullptr) return;
  for (const Leg leg : kLegs) {
    if (limbs_[leg].state() == LimbState::kLoaded) continue;
    plan_ = planner_.dock(leg, robot_now(input), ladder_of(input));
    if (plan_.ready)
      limbs_[leg].begin(plan_.goal);
    else if (in_state_s_ > params_.dock_timeout_s)
      take(E::kArmingRefused);
    return;
  }
  was_docked_ = true;
  take(E::kArmed);
}

void Controller::start_following(const ControllerInput& input) {
  PerAxis<double> measured_rad;
  for (int axis = 0; axis < kNumAxes; ++axis) measured_rad[axis] = input.axes[axis].position_rad;
  verdict_ = gate_.start_at(measured_rad);
  if (!verdict_.passed()) {
    take(E::kArmingRefused);
    return;
  }
  int num_held = 0;
  for (const Leg leg : kLegs) {
    const LimbCycle& limb = limbs_[leg];
    const bool held_before = limb.state() == LimbState::kLoaded && limb.rung_id() >= 0;
    const bool holds =
        held_before && limb.confirmation().witness().touch && !limb.confirmation().is_lost();
    limbs_[leg].reset(limb_input(input, leg), holds);
    num_held += holds ? 1 : 0;
  }
  watch_.arm(input);
  was_docked_ = num_held >= 3;  // on the ladder again, not in the dock
  following_ = true;
}

void Controller::work_climbing(const ControllerInput& input) {
  if (moving_limb() != nullptr) {
    watch_target(input);
    return;
  }
  if (shift_.active()) return;
  if (plan_.ready && limbs_[plan_.leg].returned()) {  // no grasp up there: it is back
    plan_.ready = false;
    take(E::kHold);
    return;
  }
  if (finishing_) {
    take(E::kHold);
    return;
  }
  const RobotNow now = robot_now(input);
  plan_ = planner_.next(upwards_, shifted_, now, ladder_of(input));
  if (!plan_.ready) {
    shifted_ = false;
    take(E::kHold);
  } else if (!shifted_) {
    PerLeg<LegAngles> from_rad;
    for (const Leg leg : kLegs) from_rad[leg] = limbs_[leg].target().angles_rad;
    shifted_ = true;
    if (!shift_.begin(from_rad, plan_.shift_m)) take(E::kHold);
  } else if (is_stance_firm() && limbs_[plan_.leg].begin(plan_.goal)) {
    planner_.made(plan_.leg);
    shifted_ = false;
  }
}

bool Controller::is_stance_firm() const {
  // Invariants 1 and 3: a grasp is opened only while the three others are confirmed.
  for (const Leg leg : kLegs) {
    if (!is_confirmed(limbs_[leg].state())) return false;
  }
  return true;
}

void Controller::watch_target(const ControllerInput& input) {
  LimbCycle& limb = limbs_[plan_.leg];
  const LimbState at = limb.state();
  const bool is_committed = at != LimbState::kRetracting && at != LimbState::kTransit &&
                            at != LimbState::kPregrasp && at != LimbState::kUnloading;
  if (is_committed || limb.returned() || (faults_ & flag(Fault::kPerceptionSilent)) != 0) return;
  for (const RungView& rung : input.ladder.rungs) {
    if (rung.id == limb.goal().rung_id && rung.trusted && !rung.damaged) return;
  }
  limb.abort();
}

bool Controller::must_stop(Leg leg) const {
  if (state_ == S::kClimbing || state_ == S::kArming) {
    // The others do not go on when one of three is lost.
    return action_.reaction >= Reaction::kFaultHold;
  }
  const LimbState at = limbs_[leg].state();
  const bool finishes_loading = at == LimbState::kLoading || at == LimbState::kVerify;
  return !(state_ == S::kProtectiveHold && finishes_loading);
}

void Controller::move(const ControllerInput& input) {
  const bool stop_body = state_ != S::kClimbing;
  if (following_ && shift_.active()) {
    shift_.step(params_.gate.period_s, stop_body);
    for (const Leg leg : kLegs) limbs_[leg].follow(shift_.of(leg), shift_.rate());
  }
  for (const Leg leg : kLegs) {
    if (action_.close_claws && following_) limbs_[leg].close_jaw();
    LimbInput limb = limb_input(input, leg);
    limb.stop = !following_ || must_stop(leg);
    limbs_[leg].step(limb);
  }
}

LimbInput Controller::limb_input(const ControllerInput& input, Leg leg) const {
  LimbInput limb;
  for (int joint = 0; joint < kNumLegJoints; ++joint) {
    const AxisReading& axis = input.axes[axis_of(leg, joint)];
    limb.angles_rad[joint] = axis.position_rad;
    limb.torques_Nm[joint] = axis.torque_Nm;
  }
  const AxisReading& jaw = input.axes[axis_of(leg, kJaw)];
  limb.claw = {input.touch[leg], jaw.position_rad, jaw.torque_Nm};
  limb.T_odom_body = odometry_.estimate().T_odom_body();
  limb.dt_s = params_.gate.period_s;
  return limb;
}

LadderView Controller::ladder_of(const ControllerInput& input) const {
  LadderView ladder = input.ladder;
  ladder.age_s = 1e-6 * static_cast<double>(input.now_us - input.ladder_received_us);
  return ladder;
}

RobotNow Controller::robot_now(const ControllerInput& input) const {
  RobotNow now;
  now.pose = odometry_.estimate();
  now.stance.up_body = input.imu.q_odom_body.conjugate() * Eigen::Vector3d::UnitZ();
  for (const Leg leg : kLegs) {
    now.stance.angles_rad[leg] = limb_input(input, leg).angles_rad;
    now.stance.contacts[leg].weight = limbs_[leg].target().weight;
    now.stance.contacts[leg].rung_id = limbs_[leg].rung_id();
    now.limbs[leg] = limbs_[leg].state();
  }
  return now;
}

void Controller::update_pose(const ControllerInput& input) {
  OdometryInput odometry;
  odometry.q_odom_body = input.imu.q_odom_body;
  odometry.dt_s = params_.gate.period_s;
  for (const Leg leg : kLegs) {
    odometry.angles_rad[leg] = limb_input(input, leg).angles_rad;
    odometry.weight[leg] = limbs_[leg].target().weight;
  }
  // In the dock the stand holds the body: odom begins there, and no error grows.
  if (!was_docked_) odometry_.reset();
  odometry_.update(odometry);
}

const LimbCycle* Controller::moving_limb() const {
  for (const LimbCycle& limb : limbs_) {
    if (limb.moves()) return &limb;
  }
  return nullptr;
}

}  // namespace climb
