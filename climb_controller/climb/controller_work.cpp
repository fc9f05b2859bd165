// SPDX-License-Identifier: BSD-3-Clause
// What the controller does in each of its states: boot, arming, climbing step by step, standing.
#include <algorithm>
#include <cmath>

#include "climb/controller.h"

namespace climb {

using S = ControllerState;
using E = ControllerEvent;

namespace {

constexpr FaultFlags kFalls = flag(Fault::kFreeFall) | flag(Fault::kTooFewGrasps);

/// Another look at the ladder may tell otherwise.
bool may_pass(Refusal refusal) {
  switch (refusal) {
    case Refusal::kNotTrusted:
    case Refusal::kDamaged:
    case Refusal::kLowConfidence:
    case Refusal::kRadius:
    case Refusal::kUncertain:
    case Refusal::kNoStretch:
    case Refusal::kRungMissing:
      return true;
    default:
      return false;
  }
}

PerAxis<double> measured_rad(const ControllerInput& input) {
  PerAxis<double> angles_rad;
  for (int axis = 0; axis < kNumAxes; ++axis) angles_rad[axis] = input.axes[axis].position_rad;
  return angles_rad;
}

}  // namespace

void Controller::work(const ControllerInput& input) {
  if (following_ && !input.drives_enabled) following_ = false;  // the drives hold by themselves
  if (goes_back()) way_back_.look(input.ladder);
  boot(input);
  if (state_ == S::kArming) work_arming(input);
  if (state_ == S::kClimbing) work_climbing(input);
  if (state_ == S::kFaultHold) work_put_down(input);
  if (state_ == S::kDisarming) work_disarming(input);
  move(input);
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
    // Before drives are enabled, too: their first targets are where they stand.
    verdict_ = gate_.start_at(measured_rad(input));
    const bool is_late = !input.drives_enabled && in_state_s_ > params_.enable_timeout_s;
    if (is_late || !verdict_.passed())
      take(E::kArmingRefused);
    else if (input.drives_enabled)
      start_following(input);
    return;
  }
  if (!params_.on_ladder) {  // where it stands
    take(E::kArmed);
    return;
  }
  if (const std::optional<Leg> leg = moving_leg()) return search(*leg, input);
  for (const LimbCycle& limb : limbs_) {  // claws that held before press again first
    if (limb.state() == LimbState::kLoaded && !limb.confirmation().holds()) return refuse_if_late();
  }
  if (const std::optional<Leg> leg = next_to_grasp()) {
    LimbCycle& limb = limbs_[*leg];
    // What a claw is closed round is there: no rung to avoid.
    const int avoid_rung_id = limb.confirmation().witness().jaw ? -1 : limb.lost_rung_id();
    const RobotNow now = robot_now(input);
    plan_ = planner_.dock(*leg, avoid_rung_id, now, ladder_of(input));
    if (!plan_.ready && hangs_) plan_ = planner_.beside(plan_, now, ladder_of(input));
    if (!plan_.ready) return refuse_if_late();
    limb.begin(plan_.goal);
    return;
  }
  if (!prove_grasps()) return;
  if (hangs_)
    planner_.find_turn(robot_now(input));
  else
    planner_.remember_dock(robot_now(input));
  hangs_ = true;
  take(E::kArmed);
}

void Controller::refuse_if_late() {
  if (in_state_s_ > params_.dock_timeout_s) take(E::kArmingRefused);
}

bool Controller::prove_grasps() {
  // Claws that were closed when nobody watched are pulled at, one by one, while the three others
  // hold. One that gives way stays closed: armed again, with the three others proven, it may grasp
  // anew.
  for (LimbCycle& limb : limbs_) {
    if (!limb.needs_proof() || limb.is_doubtful()) continue;
    if (!limb.prove()) refuse_if_late();
    return false;
  }
  bool all_proven = true;
  for (LimbCycle& limb : limbs_) {
    if (!limb.needs_proof()) continue;
    limb.fail();
    all_proven = false;
  }
  return all_proven;
}

std::optional<Leg> Controller::next_to_grasp() const {
  // A claw that is closed round something comes first: it only has to be verified.
  for (const bool closed : {true, false}) {
    for (const Leg leg : kLegs) {
      const LimbCycle& limb = limbs_[leg];
      const bool is_free = limb.state() != LimbState::kLoaded;
      if (is_free && limb.confirmation().witness().jaw == closed) return leg;
    }
  }
  return std::nullopt;
}

void Controller::start_following(const ControllerInput& input) {
  const PerLeg<Hold> holds = claws_round_rungs();
  const auto num_closed = kNumLegs - std::count(holds.begin(), holds.end(), Hold::kNone);
  const auto num_confirmed = std::count(holds.begin(), holds.end(), Hold::kConfirmed);
  // On the ladder the others carry what is not held; in the dock none, or the stand does.
  if (hangs_ && num_closed > 0 && num_closed < 3) {
    plan_ = PlannedStep();
    plan_.burden = Burden::kNoContact;
    take(E::kArmingRefused);
    return;
  }
  // With three closed claws it hangs again, and found so by a new controller; else it is in the
  // dock.
  const bool may_hang = hangs_ || (is_new_ && params_.on_ladder);
  hangs_ = num_confirmed >= 3 || (may_hang && num_closed >= 3);
  is_new_ = false;
  for (const Leg leg : kLegs) {
    // Where three are confirmed, or a dock bears the body, the others grasp as they are.
    const bool is_needed = hangs_ && num_confirmed < 3;
    const bool is_kept = holds[leg] == Hold::kConfirmed || is_needed;
    limbs_[leg].reset(limb_input(input, leg), is_kept ? holds[leg] : Hold::kNone);
  }
  watch_.arm(input);
  torque_part_ = hangs_ ? 1.0 : 0.0;
  following_ = began_now_ = true;
}

PerLeg<Hold> Controller::claws_round_rungs() const {
  PerLeg<Hold> holds{};
  for (const Leg leg : kLegs) {
    const LimbCycle& limb = limbs_[leg];
    if (!limb.confirmation().witness().jaw) continue;
    const bool held = limb.state() == LimbState::kLoaded || limb.state() == LimbState::kSupportLost;
    holds[leg] = held && limb.has_rung() && !limb.needs_proof() ? Hold::kConfirmed : Hold::kFelt;
  }
  return holds;
}

void Controller::work_climbing(const ControllerInput& input) {
  if (const std::optional<Leg> leg = moving_leg()) {
    watch_target(*leg, input);
    return search(*leg, input);
  }
  if (shift_.active()) return;
  const RobotNow now = robot_now(input);
  bool ends = stepping_ && !end_step(input);
  ends = ends || ends_here(now);
  if (!ends) {
    const bool may_shift = num_shifts_ < params_.max_shifts;
    plan_ = planner_.next(upwards_, may_shift, now, ladder_of(input));
    look_for_other_way(input);
    if (!plan_.ready && !other_way_) return;  // not known yet
    if (looked_s_ <= 0.0) may_step_over_ = has_other_way();
    const bool rises = plan_.at_top && !plan_.move.is_none();
    const bool is_decided = steps_over_ && may_step_over_;  // before the body was shifted for it
    if (!rises && !is_decided && looks_again()) return;
    if (!plan_.ready && may_step_over_) {
      steps_over_ = has_other_way();
      plan_ = *other_way_;
    }
    forget_other_way();
    ends = !plan_.ready && !plan_.at_dock && !rises;
  }
  if (!ends && !plan_.move.is_none()) {
    PerLeg<LegAngles> told_rad;
    for (const Leg leg : kLegs) told_rad[leg] = limbs_[leg].target().angles_rad;
    ++num_shifts_;
    ends = !begin_shift(told_rad, now.stance.angles_rad);
    if (ends && plan_.ready) plan_.refusal = Refusal::kShiftOutOfReach;
    plan_.ready = plan_.ready && !ends;
  } else if (!ends && plan_.at_dock) {
    ends = true;
  } else if (!ends && is_stance_firm() && limbs_[plan_.leg].begin(plan_.goal)) {
    T_odom_body_before_ = now.pose.T_odom_body();
    const std::optional<LimbGoal>& home = limbs_[plan_.leg].home();
    if (upwards_ && home) way_back_.leave(plan_.leg, moved(T_odom_body_before_, *home));
    stepping_ = true;
    withdrawn_ = is_vain_ = false;
  }
  if (!ends) return;
  rests_safely_ = planner_.rests_safely(now);
  take(E::kHold);
}

void Controller::look_for_other_way(const ControllerInput& input) {
  if (plan_.ready) return forget_other_way();
  const bool may_shift = num_shifts_ < params_.max_shifts;
  const std::optional<PlannedStep> found =
      planner_.over(plan_, may_shift, robot_now(input), ladder_of(input));
  if (found) other_way_ = found;
}

bool Controller::looks_again() {
  // What is seen of a rung comes and goes: one that is not good enough just now is looked at for a
  // while; one out of reach, or no ladder at all, is told at once. The top is the top when nothing
  // was seen above it all that time.
  const bool passes = plan_.at_top || may_pass(plan_.refusal) || may_step_over_;
  if (plan_.ready || !passes) {
    looked_s_ = 0.0;
    return false;
  }
  was_top_ = plan_.at_top && (was_top_ || looked_s_ <= 0.0);
  looked_s_ += params_.gate.period_s;
  if (looked_s_ < params_.look_again_s) return true;
  // So does what another way needs.
  const bool may_wait = may_step_over_ && looked_s_ < 2.0 * params_.look_again_s;
  if (may_wait && !has_other_way()) return true;
  looked_s_ = 0.0;
  if (plan_.at_top && !was_top_) {
    plan_.at_top = false;
    plan_.refusal = Refusal::kNotTrusted;
  }
  return false;
}

bool Controller::begin_shift(const PerLeg<LegAngles>& told_rad,
                             const PerLeg<LegAngles>& measured_rad) {
  // As far as all legs reach: on wide ladders the last of it comes after the step.
  for (const double part : {1.0, 0.8, 0.6, 0.4, 0.2}) {
    BodyMove move = plan_.move;
    move.shift_m *= part;
    if (shift_.begin(told_rad, measured_rad, move)) return true;
  }
  return false;
}

bool Controller::end_step(const ControllerInput& input) {
  stepping_ = false;
  const bool made = !limbs_[plan_.leg].returned();
  if (made) {
    num_shifts_ = num_withdrawn_ = 0;
    steps_over_ = false;
    if (ending_ == Ending::kAtRest && ++num_steps_to_rest_ >= kNumLegs) ending_ = Ending::kNow;
    planner_.made(plan_.leg, upwards_);
    const LimbInput limb = limb_input(input, plan_.leg);
    const Eigen::Vector3d foot_m = kinematics_.foot_m(plan_.leg, limb.angles_rad);
    if (!upwards_) way_back_.return_to(plan_.leg, limb.T_odom_body * foot_m);
  } else if (withdrawn_ && ++num_withdrawn_ < params_.max_withdrawn) {
    return true;  // it is back on its old rung and looks again
  } else {        // no grasp up there
    plan_.ready = false;
    plan_.refusal = withdrawn_ ? Refusal::kNotTrusted : Refusal::kAvoided;
    // A rung that came off, or shows its damage by now, is seen so.
    const PlannedStep once_more =
        planner_.next(upwards_, false, robot_now(input), ladder_of(input));
    if (once_more.refusal != Refusal::kNone) plan_.refusal = once_more.refusal;
    return is_vain_;  // the rung that was tried is left out, where the next one is within reach
  }
  return made;
}

bool Controller::ends_here(const RobotNow& now) const {
  if (ending_ == Ending::kNone) return false;
  return ending_ == Ending::kNow || planner_.rests_safely(now);
}

Retry Controller::retry_of(Leg leg, const ControllerInput& input) const {
  const LimbCycle& limb = limbs_[leg];
  const RobotNow now = robot_now(input);
  const Eigen::Isometry3d T_odom_body = now.pose.T_odom_body();
  Retry retry;
  retry.leg = leg;
  retry.upwards = state_ == S::kArming || upwards_;
  retry.tried_rung_id = limb.goal().rung_id;
  retry.tried_m = T_odom_body * limb.goal().grasp_m;
  retry.from_m =
      limb.home() ? T_odom_body * limb.home()->grasp_m : planner_.docked_from_m(leg, now);
  return retry;
}

void Controller::search(Leg leg, const ControllerInput& input) {
  LimbCycle& limb = limbs_[leg];
  if (!limb.wants_goal()) return;
  Retry retry = retry_of(leg, input);
  const bool is_first_place = limb.num_places() == 1;
  for (const Retry::Where where : {Retry::Where::kBeside, Retry::Where::kOtherRung}) {
    retry.where = where;
    if (where == Retry::Where::kBeside && !is_first_place) continue;
    const PlannedStep elsewhere = planner_.again(retry, robot_now(input), ladder_of(input));
    if (elsewhere.ready) return limb.retarget(elsewhere.goal);
  }
  if (state_ == S::kClimbing) {
    planner_.remember_vain(retry.tried_m);
    is_vain_ = true;
  }
  limb.give_up();
}

bool Controller::is_stance_firm() const {
  // Invariants 1 and 3: a grasp is opened only while the three others are confirmed.
  for (const Leg leg : kLegs) {
    if (!is_confirmed(limbs_[leg].state()) || !limbs_[leg].confirmation().holds()) return false;
  }
  return true;
}

void Controller::watch_target(Leg leg, const ControllerInput& input) {
  LimbCycle& limb = limbs_[leg];
  const LimbState at = limb.state();
  const bool is_before_commit = at == LimbState::kUnloading || at == LimbState::kReleasing ||
                                at == LimbState::kRetracting || at == LimbState::kTransit ||
                                at == LimbState::kPregrasp;
  const bool is_blind = (faults_ & flag(Fault::kPerceptionSilent)) != 0;
  if (!is_before_commit || limb.returned() || is_blind) return;
  const Eigen::Vector3d goal_m = odometry_.estimate().T_odom_body() * limb.goal().grasp_m;
  if (planner_.offers(limb.goal().rung_id, goal_m, ladder_of(input))) return;
  // Lifted off, the body tilts a little, and with it what is far ahead.
  const PlannedStep there =
      planner_.again(retry_of(leg, input), robot_now(input), ladder_of(input));
  const double moved_m = (there.goal.grasp_m - limb.goal().grasp_m).norm();
  if (there.ready && moved_m <= params_.climb.grasp.same_rung_m) return limb.aim_at(there.goal);
  withdrawn_ = limb.abort();
}

bool Controller::must_stop(Leg leg) const {
  if (began_now_) return true;  // invariant 6: the first targets are the measured positions
  if (putting_down_ == leg) return false;
  const bool parks = state_ == S::kDisarming && parking_;
  if (state_ == S::kClimbing || state_ == S::kArming || parks) {
    // The others do not go on when one of three is lost.
    return action_.reaction >= Reaction::kFaultHold;
  }
  // Blind, but with a rung between its fingers: that is finished.
  const LimbState at = limbs_[leg].state();
  const bool is_at_rung =
      at == LimbState::kClosing || at == LimbState::kVerify || at == LimbState::kLoading;
  return !(state_ == S::kProtectiveHold && is_at_rung);
}

void Controller::move(const ControllerInput& input) {
  const bool stop_body = state_ != S::kClimbing;
  if (following_ && shift_.active()) {
    shift_.step(params_.gate.period_s, stop_body);
    for (const Leg leg : kLegs) limbs_[leg].follow(shift_.of(leg), shift_.rate());
  }
  for (const Leg leg : kLegs) {
    // Who holds tightens its grip; who is in the air closes only when it falls.
    const bool is_to_grip = !limbs_[leg].moves() || (faults_ & kFalls) != 0;
    if (action_.close_claws && following_ && is_to_grip) limbs_[leg].close_jaw();
    LimbInput limb = limb_input(input, leg);
    limb.others_hold = limb.others_hold || parking_;  // in the dock
    limb.docked = !hangs_ || parking_;
    limb.stop = !following_ || must_stop(leg);
    limb.follows = following_;
    limbs_[leg].step(limb);
  }
}

}  // namespace climb
