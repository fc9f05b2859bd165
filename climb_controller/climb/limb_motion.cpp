// SPDX-License-Identifier: BSD-3-Clause
// How a limb's targets move: along its path, its jaw at its pace, and how hard it pulls.
#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "base/within.h"
#include "climb/limb_cycle.h"

namespace climb {
namespace {

constexpr double kOpenWindow_rad = 0.1;
constexpr double kGiveWayPart = 0.03;
constexpr double kYieldPart = 0.3;  ///< of what pushes it aside, each cycle

}  // namespace

std::string check(const LimbParams& p) {
  if (!base::within(p.jaw_speed_rad_s, 0.1, 100.0)) return "limb.jaw_speed_rad_s must be 0.1..100";
  const bool times_ok =
      base::within(p.close_timeout_s, 0.1, 60.0) && base::within(p.open_timeout_s, 0.1, 60.0) &&
      base::within(p.others_timeout_s, 0.0, 60.0) && base::within(p.budget_s, 0.1, 600.0);
  if (!times_ok) {
    return "limb: close_timeout_s and open_timeout_s must be 0.1..60, others_timeout_s 0..60, "
           "budget_s 0.1..600";
  }
  if (!(p.max_tries >= 1 && p.max_tries_elsewhere >= 1)) {
    return "limb: max_tries and max_tries_elsewhere must be above 0";
  }
  if (!base::within(p.try_offset_m, 0.0, 0.1)) return "limb.try_offset_m must be 0..0.1";
  if (!base::within(p.empty_window_rad, 0.0, 1.0)) return "limb.empty_window_rad must be 0..1";
  return "";
}

LimbGoal moved(const Eigen::Isometry3d& T_to_from, const LimbGoal& goal) {
  LimbGoal there = goal;
  there.pregrasp_m = T_to_from * goal.pregrasp_m;
  there.grasp_m = T_to_from * goal.grasp_m;
  there.axis = T_to_from.linear() * goal.axis;
  return there;
}

void LimbCycle::follow(const JointSample& sample, double rate) {
  if (state_ != LimbState::kLoaded) return;
  target_.angles_rad = sample.angles_rad;
  target_.velocity_rad_s = rate * sample.velocity_rad_s;
  move_joints(sample.angles_rad, 0.0);
}

void LimbCycle::give_way() {
  if (state_ != LimbState::kLoaded) return;
  const LegAngles measured_rad = kinematics_.clamped(leg_, input_.angles_rad);
  stand_at(target_.angles_rad + kGiveWayPart * (measured_rad - target_.angles_rad));
}

void LimbCycle::move_joints(const LegAngles& to_rad, double min_duration_s) {
  line_.reset();
  segment_ =
      JointSegment(target_.angles_rad, kinematics_.clamped(leg_, to_rad), limits_, min_duration_s);
  clock_.restart();
}

void LimbCycle::move_foot(const Eigen::Vector3d& to_m, double speed_m_s) {
  const Eigen::Vector3d from_m = kinematics_.foot_m(leg_, target_.angles_rad);
  line_.emplace(kinematics_, leg_, from_m, to_m, LineSpeed{speed_m_s, motion_.cartesian_m_s2});
  clock_.restart();
  if (line_->reach() == Reach::kReachable) return;
  const LegSolution end = kinematics_.inverse(leg_, to_m);
  move_joints(end.reachable() ? end.angles_rad : target_.angles_rad, 0.0);
}

bool LimbCycle::advance(const LimbInput& input) {
  if (state_ == LimbState::kLoaded || state_ == LimbState::kSupportLost) return false;
  const bool slows = state_ == LimbState::kAbortReturn && stage_ == Stage::kSlowing;
  const bool stop = input.stop || slows;
  const auto follow_path = [&](const auto& path) {
    clock_.advance(input.dt_s, stop, path, limits_);
    const JointSample sample = path.at(clock_.path_time_s());
    target_.angles_rad = sample.angles_rad;
    target_.velocity_rad_s = clock_.rate() * sample.velocity_rad_s;
    return clock_.path_time_s() >= path.duration_s() && !stop;
  };
  return line_ ? follow_path(*line_) : follow_path(segment_);
}

double LimbCycle::path_part() const {
  const double duration_s = line_ ? line_->duration_s() : segment_.duration_s();
  return duration_s > 0.0 ? std::min(1.0, clock_.path_time_s() / duration_s) : 1.0;
}

void LimbCycle::move_jaw(const LimbInput& input) {
  if (input.stop && !is_jaw_forced_) return;
  const bool closes = is_jaw_forced_ || must_stay_closed(input);
  const double goal_rad = closes ? claw_.closed_rad : jaw_goal_rad_;
  const double step_rad = params_.jaw_speed_rad_s * input.dt_s;
  target_.jaw_rad += std::clamp(goal_rad - target_.jaw_rad, -step_rad, step_rad);
}

bool LimbCycle::is_open(const LimbInput& input) const {
  return input.claw.jaw_rad >= claw_.open_rad - kOpenWindow_rad;
}

Eigen::Vector3d LimbCycle::rung_force_N(const LimbInput& input) const {
  // tau = -J^T f of the rung on the foot: the change since the claw came to it.
  const Eigen::Matrix3d J = kinematics_.jacobian(leg_, input.angles_rad);
  const LegAngles change_Nm = input.torques_Nm - torques_before_Nm_;
  return -(J.transpose().inverse() * change_Nm);
}

double LimbCycle::try_offset_m() const {
  // The first try as aimed, then above it, then below.
  if (num_tries_ == 0) return 0.0;
  return num_tries_ % 2 == 1 ? params_.try_offset_m : -params_.try_offset_m;
}

Eigen::Vector3d LimbCycle::aimed_m(const Eigen::Vector3d& point_m) const {
  // Below the fixed finger a rung has 3 mm to spare, above the jaw five times as much.
  const LegSolution there = kinematics_.inverse(leg_, goal_.grasp_m);
  if (!there.reachable()) return point_m;
  const Eigen::Matrix3d R_body_claw = kinematics_.R_body_claw(leg_, there.angles_rad);
  return point_m + (motion_.aim_up_m + try_offset_m()) * R_body_claw.col(0) +
         motion_.aim_out_m * R_body_claw.col(2);
}

void LimbCycle::follow_body() {
  const Eigen::Isometry3d T_now_before = input_.T_odom_body.inverse() * T_odom_body_;
  T_odom_body_ = input_.T_odom_body;
  goal_ = moved(T_now_before, goal_);
  if (home_) home_ = moved(T_now_before, *home_);
  if (way_out_m_) way_out_m_ = T_now_before * *way_out_m_;
  if (way_past_m_) way_past_m_ = T_now_before * *way_past_m_;
}

ExpectedRung LimbCycle::expected_rung(const LimbInput& input) const {
  // What is let go is the old rung still.
  const bool is_on_old = state_ == LimbState::kUnloading || state_ == LimbState::kReleasing;
  const LimbGoal& rung = is_on_old && home_ ? *home_ : goal_;
  // An abducted leg's claw stands aslant on its rung: that opens the jaw as a thicker one would.
  const Eigen::Matrix3d R_now_before =
      input.T_odom_body.linear().transpose() * T_odom_body_.linear();
  const Eigen::Vector3d axis_claw =
      kinematics_.R_body_claw(leg_, input.angles_rad).transpose() * (R_now_before * rung.axis);
  return {rung.radius_m, axis_claw.z() / axis_claw.y()};
}

void LimbCycle::stand_at(const LegAngles& angles_rad) {
  target_.angles_rad = angles_rad;
  target_.velocity_rad_s.setZero();
  move_joints(angles_rad, 0.0);
}

void LimbCycle::stand_free() {
  moves_ = false;
  held_rung_id_ = -1;
  needs_proof_ = is_guess_ = false;
  target_.weight = 0.0;
  move_joints(target_.angles_rad, 0.0);
}

bool LimbCycle::comes_from_above(const Eigen::Vector3d& foot_m) const {
  return foot_m.x() > goal_.pregrasp_m.x() + motion_.retract_m;
}

// Out before the rung that is passed; or before the rung it goes to, since on a straight way down
// the open jaw would strike it (run: with 118 N).
void LimbCycle::go_past() {
  const Eigen::Vector3d foot_m = kinematics_.foot_m(leg_, target_.angles_rad);
  const Eigen::Vector3d end_m = aimed_m(goal_.pregrasp_m);
  way_past_m_ = goal_.is_beyond ? Eigen::Vector3d(0.5 * (foot_m + end_m)) : end_m;
  way_past_m_->z() += motion_.clear_m;
  stage_ = Stage::kPast;
  move_foot(*way_past_m_, motion_.transit_m_s);
}

void LimbCycle::work_transit(bool arrived) {
  if (!arrived) return;
  if (stage_ == Stage::kOver) {
    take(LimbEvent::kDone);
    return;
  }
  stage_ = Stage::kOver;
  move_foot(aimed_m(goal_.pregrasp_m), motion_.transit_m_s);
}

void LimbCycle::return_home(const LimbInput& input, bool arrived) {
  if (input.stop) return;
  switch (stage_) {
    case Stage::kSlowing:
      if (!clock_.stands()) return;
      stage_ = Stage::kOut;
      return move_foot(way_out_m_.value_or(kinematics_.foot_m(leg_, target_.angles_rad)),
                       motion_.retract_m_s);
    case Stage::kOut:
      if (!arrived) return;
      stay_home();
      way_out_m_.reset();
      stage_ = way_past_m_ ? Stage::kPast : Stage::kOver;
      return move_foot(way_past_m_.value_or(goal_.pregrasp_m), motion_.transit_m_s);
    case Stage::kPast:
      if (!arrived) return;
      stage_ = Stage::kOver;
      return move_foot(goal_.pregrasp_m, motion_.transit_m_s);
    case Stage::kOver:
      if (arrived) take(LimbEvent::kDone);
      return;
  }
}

void LimbCycle::yield(const LimbInput& input) {
  // The closing jaw draws the claw to its seat on the rung; stiff joints would pull against it.
  stand_at(target_.angles_rad +
           kYieldPart * (kinematics_.clamped(leg_, input.angles_rad) - target_.angles_rad));
}

void LimbCycle::pull(const LimbInput& input, bool arrived) {
  const double force_N = rung_force_N(input).norm();
  const bool is_further = stage_ == Stage::kOut;
  const double enough_N = is_further ? motion_.pull_test_min_N : motion_.pull_test_max_N;
  // A stretched leg is soft: what stays in the claw is pulled further, to the force asked for.
  const bool stays = confirmation_.witness().closed() &&
                     std::abs(pull_slip_m(input)) < motion_.pull_test_max_slip_m;
  const bool is_enough = force_N >= enough_N || (is_further && !stays);
  if (!arrived && (input.stop || !is_enough)) return;
  if (is_further || !stays || force_N >= motion_.pull_test_min_N) return finish_pull(input);
  stage_ = Stage::kOut;
  const Eigen::Vector3d foot_m = kinematics_.foot_m(leg_, target_.angles_rad);
  const double further_m = proves_ ? motion_.prove_further_m : motion_.pull_further_m;
  move_foot(foot_m + Eigen::Vector3d(0.0, 0.0, further_m), pull_m_s());
}

double LimbCycle::pull_slip_m(const LimbInput& input) const {
  const Eigen::Vector3d from_m = input.T_odom_body.inverse() * pulled_from_m_;
  return (kinematics_.foot_m(leg_, input.angles_rad) - from_m).z();
}

void LimbCycle::finish_pull(const LimbInput& input) {
  last_witness_ = confirmation_.conclude({pull_slip_m(input), rung_force_N(input).norm()});
  // On fewer than three others the body gives way too much to be pulled at, and what has closed on
  // a rung is not opened again (invariant 3).
  // Nor is one that was only to be proven.
  const bool is_needed = proves_ || (!input.others_hold && last_witness_.closed());
  if (last_witness_.all()) needs_proof_ = false;
  is_doubtful_ = needs_proof_;
  take(last_witness_.all() || is_needed ? LimbEvent::kDone : LimbEvent::kMissed);
}

void LimbCycle::load(const LimbInput& input, bool arrived) {
  if (stage_ == Stage::kSlowing) {
    if (!arrived) return;
    // Down until the finger lies on the rung: a claw that only its jaw keeps up would settle later,
    // and the body with it.
    stage_ = Stage::kOut;
    const Eigen::Vector3d foot_m = kinematics_.foot_m(leg_, target_.angles_rad);
    return move_foot(foot_m - Eigen::Vector3d(motion_.seat_m, 0.0, 0.0), motion_.seat_m_s);
  }
  if (stage_ == Stage::kOut) {
    const bool is_seated = !input.stop && rung_force_N(input).x() >= motion_.seat_N;
    if (is_seated) stand_at(target_.angles_rad);
    if (!is_seated && !arrived) return;
    stage_ = Stage::kOver;
    in_state_s_ = 0.0;
  }
  target_.weight = std::max(target_.weight, std::min(1.0, in_state_s_ / motion_.load_s));
  if (arrived && in_state_s_ >= motion_.load_s) take(LimbEvent::kDone);
}

void LimbCycle::feel_bump(const LimbInput& input) {
  if (input.stop || !(rung_force_N(input).norm() >= motion_.bump_N)) return;
  const Eigen::Vector3d left_m =
      aimed_m(goal_.grasp_m) - kinematics_.foot_m(leg_, target_.angles_rad);
  stand_at(kinematics_.clamped(leg_, input.angles_rad));
  take(left_m.norm() <= motion_.bump_near_m ? LimbEvent::kDone : LimbEvent::kMissed);
}

}  // namespace climb
