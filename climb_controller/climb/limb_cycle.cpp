// SPDX-License-Identifier: BSD-3-Clause
#include "climb/limb_cycle.h"

#include <algorithm>

namespace climb {
namespace {

/// No number of perception's; another for each leg.
constexpr int kFeltRungId = -2;

}  // namespace

LimbCycle::LimbCycle(const RobotParams& robot, const MotionParams& motion, const LimbParams& params,
                     const ConfirmationParams& confirmation, Leg leg)
    : kinematics_(robot),
      limits_(leg_limits(kinematics_, leg)),
      claw_(robot.claw),
      motion_(motion),
      params_(params),
      leg_(leg),
      confirmation_(robot.claw, motion, confirmation) {}

void LimbCycle::reset(const LimbInput& measured, Hold hold) {
  const bool holds = hold != Hold::kNone;
  input_ = measured;
  state_ = holds ? LimbState::kLoaded : LimbState::kPregrasp;
  target_ = {measured.angles_rad, LegAngles::Zero(), measured.claw.jaw_rad, holds ? 1.0 : 0.0};
  jaw_goal_rad_ = holds ? claw_.closed_rad : measured.claw.jaw_rad;  // nothing opens unasked
  moves_ = parks_ = wants_goal_ = failed_ = is_jaw_forced_ = false;
  if (hold != Hold::kConfirmed) {
    held_rung_id_ = hold == Hold::kFelt ? kFeltRungId - leg_ : -1;
    goal_ = {};
    T_odom_body_ = measured.T_odom_body;
    needs_proof_ = is_guess_ = hold == Hold::kFelt;
    is_doubtful_ = false;
  }
  proves_ = false;
  home_.reset();
  forget_tries();
  in_state_s_ = waited_s_ = 0.0;
  confirmation_.forgive();
  if (holds) confirmation_.press_again(params_.press_again_s);
  move_joints(measured.angles_rad, 0.0);
}

void LimbCycle::forget_tries() {
  returned_ = false;
  way_out_m_.reset();
  way_past_m_.reset();
  num_tries_ = 0;
  num_places_ = 1;
  spent_s_ = 0.0;
}

bool LimbCycle::begin(const LimbGoal& goal) {
  const bool is_free = state_ == LimbState::kPregrasp && !moves_;
  const bool may_begin = !failed_ && (state_ == LimbState::kLoaded || is_free);
  if (!may_begin) return false;
  follow_body();
  remember_home();
  goal_ = goal;
  moves_ = true;
  forget_tries();
  if (state_ == LimbState::kLoaded) return take(LimbEvent::kLift);
  // Where it stands after a reset: round a rung perhaps, then it is verified there; half closed,
  // then it opens before it moves.
  if (!is_open(input_))
    state_ = confirmation_.witness().jaw ? LimbState::kClosing : LimbState::kRegrasp;
  enter(LimbState::kPregrasp);
  return true;
}

bool LimbCycle::prove() {
  if (state_ != LimbState::kLoaded || moves_ || failed_) return false;
  follow_body();
  remember_home();
  goal_ = *home_;
  moves_ = proves_ = true;
  forget_tries();
  return take(LimbEvent::kProve);
}

bool LimbCycle::park() {
  if (state_ != LimbState::kLoaded || !begin({})) return false;
  parks_ = true;
  return true;
}

void LimbCycle::remember_home() {
  home_.reset();
  if (state_ != LimbState::kLoaded) return;
  const Eigen::Vector3d held_m = kinematics_.foot_m(leg_, input_.angles_rad);
  const Eigen::Vector3d out_m =
      motion_.pregrasp_m * kinematics_.retract_direction(leg_, input_.angles_rad);
  home_ = LimbGoal{held_rung_id_, held_m + out_m, held_m, goal_.radius_m, goal_.axis};
}

bool LimbCycle::take(LimbEvent event) {
  const std::optional<LimbState> next = after(state_, event);
  if (!next) return false;
  const LimbState from = state_;
  state_ = *next;
  enter(from);
  return true;
}

void LimbCycle::enter(LimbState from) {
  in_state_s_ = waited_s_ = 0.0;
  wants_goal_ = false;
  stage_ = Stage::kOver;
  follow_body();
  const Eigen::Vector3d foot_m = kinematics_.foot_m(leg_, target_.angles_rad);
  switch (state_) {
    case LimbState::kUnloading:
      return move_joints(input_.angles_rad, motion_.unload_s);
    case LimbState::kReleasing:
      jaw_goal_rad_ = claw_.open_rad;
      return;
    case LimbState::kRetracting:
      return move_foot(
          foot_m + motion_.retract_m * kinematics_.retract_direction(leg_, target_.angles_rad),
          motion_.retract_m_s);
    case LimbState::kTransit:
      if (goal_.is_beyond || comes_from_above(foot_m)) return go_past();
      return move_foot(aimed_m(goal_.pregrasp_m), motion_.transit_m_s);
    case LimbState::kPregrasp:
      if (parks_ || from == LimbState::kLoaded) return stand_free();
      jaw_goal_rad_ = claw_.open_rad;
      stage_ = way_out_m_ ? Stage::kOut : Stage::kOver;
      return move_foot(way_out_m_.value_or(aimed_m(goal_.pregrasp_m)), motion_.transit_m_s);
    case LimbState::kApproach:
      way_out_m_ = foot_m;
      torques_before_Nm_ = input_.torques_Nm;
      return move_foot(aimed_m(goal_.grasp_m), motion_.approach_m_s);
    case LimbState::kClosing:
      if (from == LimbState::kReleasing) stay_home();  // opened a little and closed again
      if (is_first_try()) spent_s_ = 0.0;
      torques_before_Nm_ = input_.torques_Nm;
      jaw_goal_rad_ = claw_.closed_rad;
      return;
    case LimbState::kVerify:
      unpulled_rad_ = input_.angles_rad;
      pulled_from_m_ = input_.T_odom_body * kinematics_.foot_m(leg_, input_.angles_rad);
      // What the closing jaw already draws on the rung counts: it adds to the pull.
      if (from != LimbState::kClosing) torques_before_Nm_ = input_.torques_Nm;
      // So does what a claw bears that was found loaded.
      if (from == LimbState::kLoaded) torques_before_Nm_.setZero();
      return move_foot(foot_m + Eigen::Vector3d(0.0, 0.0, motion_.pull_test_m), pull_m_s());
    case LimbState::kLoading:
      if (from == LimbState::kVerify) {
        // What was pulled is let go: legs that pull against each other turn the body.
        stage_ = Stage::kSlowing;
        return move_joints(unpulled_rad_, 0.5 * motion_.pull_s);
      }
      stay_home();
      return move_joints(input_.angles_rad, motion_.load_s);  // re-reference: never a step
    case LimbState::kLoaded:
      moves_ = parks_ = proves_ = false;
      way_out_m_.reset();
      target_.weight = 1.0;
      target_.velocity_rad_s.setZero();
      held_rung_id_ = goal_.rung_id;
      lost_rung_id_ = -1;
      return;
    case LimbState::kRegrasp:
      ++num_tries_;
      failed_ = failed_ || needs_proof_;  // what held when nobody watched is not opened
      target_.weight = 0.0;
      jaw_goal_rad_ = claw_.open_rad;
      return;
    case LimbState::kAbortReturn:
      jaw_goal_rad_ = claw_.open_rad;
      stage_ = Stage::kSlowing;  // along the path that it is on
      return;
    case LimbState::kSupportLost:
      target_.weight = 0.0;
      moves_ = parks_ = false;
      lost_rung_id_ = held_rung_id_;
      return;
  }
}

void LimbCycle::step(const LimbInput& input) {
  input_ = input;
  input_.stop = input.stop || failed_;  // it stays where it found nothing
  confirmation_.expect(expected_rung(input));
  confirmation_.update(input.claw, input.dt_s);
  if (moves_ && !input_.stop) spent_s_ += input.dt_s;
  if (!input_.stop) in_state_s_ += input.dt_s;
  move_jaw(input_);
  work(input_);
  keep_budget();
}

void LimbCycle::work(const LimbInput& input) {
  const bool arrived = advance(input);
  switch (state_) {
    case LimbState::kLoaded:
      // What closes on nothing never held.
      if (confirmation_.holds()) is_guess_ = false;
      if (has_lost(input)) take(is_guess_ ? LimbEvent::kMissed : LimbEvent::kLost);
      return;
    case LimbState::kUnloading:
      target_.weight = 1.0 - path_part();
      if (has_lost(input))
        take(LimbEvent::kLost);
      else if (arrived)
        work_release(input, arrived);
      return;
    case LimbState::kReleasing:
      return work_release(input, arrived);
    case LimbState::kRetracting:
      if (arrived) take(parks_ ? LimbEvent::kPark : LimbEvent::kDone);
      return;
    case LimbState::kTransit:
      return work_transit(arrived);
    case LimbState::kApproach:
      if (arrived)
        take(LimbEvent::kDone);
      else
        feel_bump(input);
      return;
    case LimbState::kPregrasp:
      return work_pregrasp(input, arrived);
    case LimbState::kClosing:
      return finish_closing(input);
    case LimbState::kVerify:
      return pull(input, arrived);
    case LimbState::kLoading:
      if (has_lost(input))
        take(LimbEvent::kLost);
      else
        load(input, arrived);
      return;
    case LimbState::kRegrasp:
      return work_regrasp(input);
    case LimbState::kAbortReturn:
      return return_home(input, arrived);
    case LimbState::kSupportLost:
      return;
  }
}

bool LimbCycle::has_lost(const LimbInput& input) const {
  // Drives that stopped by themselves may press no more; the claw is round its rung still.
  return confirmation_.is_lost() && (input.follows || !confirmation_.witness().jaw);
}

void LimbCycle::work_release(const LimbInput& input, bool arrived) {
  if (input.stop) return;
  if (state_ == LimbState::kUnloading) {
    // The jaw opens only while the three others hold in this very cycle (invariant 3).
    if (arrived && input.others_hold)
      take(LimbEvent::kDone);
    else if ((waited_s_ += input.dt_s) >= params_.others_timeout_s)
      take(LimbEvent::kAbort);
    return;
  }
  if (is_open(input) && in_state_s_ >= motion_.open_s)
    take(LimbEvent::kDone);
  else if (in_state_s_ >= params_.open_timeout_s)
    take(LimbEvent::kAbort);  // a jaw that does not open holds still
}

void LimbCycle::work_pregrasp(const LimbInput& input, bool arrived) {
  if (!moves_ || !arrived) return;
  if (stage_ == Stage::kOut) {
    stage_ = Stage::kOver;
    way_out_m_.reset();
    move_foot(aimed_m(goal_.pregrasp_m), motion_.transit_m_s);
  } else if (is_open(input)) {
    if (in_state_s_ >= motion_.settle_s) take(LimbEvent::kDone);
  } else if (waits_too_long(input)) {
    failed_ = true;
  }
}

void LimbCycle::work_regrasp(const LimbInput& input) {
  if (input.stop) return;
  if (!is_open(input)) {
    failed_ = waits_too_long(input);  // half open, in front of a rung that does not hold
    return;
  }
  const bool is_first_place = num_places_ == 1;
  const int max_tries = is_first_place ? params_.max_tries : params_.max_tries_elsewhere;
  if (is_over_budget())
    give_up();
  else if (num_tries_ < max_tries)
    take(LimbEvent::kDone);
  else if (returned_)
    failed_ = true;  // it stands here, open, in front of a rung that does not hold
  else
    wants_goal_ = true;
}

void LimbCycle::retarget(const LimbGoal& goal) {
  if (!wants_goal_) return;
  follow_body();
  goal_ = goal;
  num_tries_ = 0;
  ++num_places_;
  take(LimbEvent::kDone);
}

void LimbCycle::aim_at(const LimbGoal& goal) {
  if (!moves_ || returned_) return;
  follow_body();
  goal_ = goal;
}

void LimbCycle::give_up() {
  if (!home_ || returned_ || !take(LimbEvent::kGiveUp)) failed_ = true;
}

void LimbCycle::put_down(const LimbGoal& goal) {
  is_jaw_forced_ = false;
  spent_s_ = 0.0;
  if (state_ == LimbState::kRegrasp && confirmation_.witness().jaw) {
    take(LimbEvent::kAbort);  // round its rung still: it closes again
    return;
  }
  const bool is_coming = state_ == LimbState::kApproach && goal.rung_id == goal_.rung_id;
  const bool is_at_rung = state_ == LimbState::kClosing || state_ == LimbState::kVerify ||
                          state_ == LimbState::kLoading;
  if (!moves_ || is_coming || is_at_rung) return;
  const bool is_on_its_rung = state_ == LimbState::kUnloading || state_ == LimbState::kReleasing;
  follow_body();
  if (!is_on_its_rung) home_ = goal;
  returned_ = false;
  if (state_ == LimbState::kAbortReturn)
    enter(LimbState::kAbortReturn);
  else if (!take(LimbEvent::kAbort))
    take(LimbEvent::kGiveUp);
}

void LimbCycle::finish_closing(const LimbInput& input) {
  if (input.stop) return;
  yield(input);
  const bool is_quiet = rung_force_N(input).norm() <= motion_.seat_N;
  const double enough_s = is_quiet ? motion_.close_s : 2.0 * motion_.close_s;
  if (confirmation_.witness().closed() && in_state_s_ >= enough_s) {
    take(LimbEvent::kDone);
    return;
  }
  const bool is_empty = input.claw.jaw_rad <= claw_.closed_rad + params_.empty_window_rad;
  const bool is_late = in_state_s_ >= params_.close_timeout_s || is_over_budget();
  if (is_late || (is_empty && in_state_s_ >= 2.0 * motion_.close_s)) {
    last_witness_ = confirmation_.witness();
    confirmation_.conclude_missed();
    take(LimbEvent::kMissed);
  }
}

void LimbCycle::keep_budget() {
  if (!moves_ || failed_ || !is_over_budget()) return;
  const bool is_searching = state_ == LimbState::kTransit || state_ == LimbState::kPregrasp ||
                            state_ == LimbState::kApproach;
  if (!is_searching) return;  // a rung in the claw is verified; everything else is short
  if (!home_ || returned_ || !take(LimbEvent::kAbort)) failed_ = true;
}

void LimbCycle::stay_home() {
  goal_ = home_.value_or(goal_);
  returned_ = true;
  parks_ = false;
  num_tries_ = 0;
  num_places_ = 1;
  spent_s_ = 0.0;
}

bool LimbCycle::must_stay_closed(const LimbInput& input) const {
  // Not confirmed, but round something: on fewer than three others it is not let go (invariant 3).
  return state_ == LimbState::kRegrasp && !input.others_hold && !input.docked &&
         confirmation_.witness().jaw;
}

bool LimbCycle::waits_too_long(const LimbInput& input) {
  waited_s_ += input.dt_s;
  return waited_s_ >= params_.open_timeout_s;
}

}  // namespace climb
