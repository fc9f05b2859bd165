// SPDX-License-Identifier: BSD-3-Clause
#include "climb/limb_cycle.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace climb {
namespace {

using S = LimbState;

constexpr double kOpenWindow_rad = 0.1;

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

void LimbCycle::reset(const LimbInput& measured, bool holds) {
  input_ = measured;
  state_ = holds ? S::kLoaded : S::kPregrasp;
  target_ = {measured.angles_rad, LegAngles::Zero(), measured.claw.jaw_rad, holds ? 1.0 : 0.0};
  jaw_goal_rad_ = holds ? claw_.closed_rad : measured.claw.jaw_rad;  // nothing opens unasked
  moves_ = returned_ = failed_ = is_jaw_forced_ = false;
  if (!holds) held_rung_id_ = -1;
  home_.reset();
  num_tries_ = 0;
  spent_s_ = in_state_s_ = 0.0;
  confirmation_.forgive();
  move_joints(measured.angles_rad, 0.0);
}

bool LimbCycle::begin(const LimbGoal& goal) {
  const bool is_free = state_ == S::kPregrasp && !moves_;
  const bool may_begin = !failed_ && (state_ == S::kLoaded || is_free);
  if (!may_begin) return false;
  home_.reset();
  if (state_ == S::kLoaded) {
    const Eigen::Vector3d held_m = kinematics_.foot_m(leg_, input_.angles_rad);
    const Eigen::Vector3d out_m(0.0, 0.0, motion_.pregrasp_m);
    home_ = LimbGoal{held_rung_id_, held_m + out_m, held_m};
  }
  goal_ = goal;
  moves_ = true;
  returned_ = false;
  num_tries_ = 0;
  spent_s_ = 0.0;
  if (state_ == S::kLoaded) return take(LimbEvent::kLift);
  // Where it stands after a reset: round a rung perhaps, then it is verified there; half closed,
  // then it opens before it moves.
  if (!is_open(input_)) state_ = confirmation_.witness().touch ? S::kClosing : S::kRegrasp;
  enter(S::kPregrasp);
  return true;
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
  in_state_s_ = 0.0;
  stage_ = 0;
  const Eigen::Vector3d foot_m = kinematics_.foot_m(leg_, target_.angles_rad);
  switch (state_) {
    case S::kUnloading:
      return move_joints(input_.angles_rad, motion_.unload_s);
    case S::kReleasing:
      jaw_goal_rad_ = claw_.open_rad;
      return;
    case S::kRetracting:
      return move_foot(
          foot_m + motion_.retract_m * kinematics_.retract_direction(leg_, target_.angles_rad),
          motion_.retract_m_s);
    case S::kTransit:
    case S::kPregrasp:
      jaw_goal_rad_ = claw_.open_rad;
      return move_foot(goal_.pregrasp_m + approach_offset_m(), motion_.transit_m_s);
    case S::kApproach:
      return move_foot(goal_.grasp_m + approach_offset_m(), motion_.approach_m_s);
    case S::kClosing:
      if (from == S::kReleasing) stay_home();  // opened a little and closed again
      jaw_goal_rad_ = claw_.closed_rad;
      return;
    case S::kVerify:
      pulled_from_m_ = input_.T_odom_body * kinematics_.foot_m(leg_, input_.angles_rad);
      torques_before_Nm_ = input_.torques_Nm;
      return move_foot(foot_m + Eigen::Vector3d(0.0, 0.0, motion_.pull_test_m),
                       motion_.pull_test_m * 1.875 / motion_.pull_s);
    case S::kLoading:
      if (from == S::kUnloading) stay_home();
      return move_joints(input_.angles_rad, motion_.load_s);  // re-reference: never a step
    case S::kLoaded:
      moves_ = false;
      target_.weight = 1.0;
      target_.velocity_rad_s.setZero();
      held_rung_id_ = goal_.rung_id;
      return;
    case S::kRegrasp:
      ++num_tries_;
      target_.weight = 0.0;
      jaw_goal_rad_ = claw_.open_rad;
      return;
    case S::kAbortReturn:
      jaw_goal_rad_ = claw_.open_rad;
      // Out of the new rung first, where the claw may be round it.
      stage_ = from == S::kApproach || from == S::kRegrasp ? 0 : 1;
      return move_joints(target_.angles_rad, 0.0);
    case S::kSupportLost:
      target_.weight = 0.0;
      moves_ = false;
      return;
  }
}

void LimbCycle::step(const LimbInput& input) {
  input_ = input;
  confirmation_.update(input.claw, input.dt_s);
  if (moves_ && !input.stop) spent_s_ += input.dt_s;
  if (!input.stop) in_state_s_ += input.dt_s;
  move_jaw(input);
  work(input);
}

void LimbCycle::work(const LimbInput& input) {
  const bool arrived = advance(input);
  const bool held_on = !input.stop;
  switch (state_) {
    case S::kLoaded:
      if (confirmation_.is_lost()) take(LimbEvent::kLost);
      return;
    case S::kUnloading:
      target_.weight = 1.0 - path_part();
      if (confirmation_.is_lost())
        take(LimbEvent::kLost);
      else if (arrived)
        take(LimbEvent::kDone);
      return;
    case S::kReleasing:
      if (is_open(input) && in_state_s_ >= motion_.open_s && held_on) take(LimbEvent::kDone);
      return;
    case S::kRetracting:
    case S::kTransit:
    case S::kApproach:
      if (arrived) take(LimbEvent::kDone);
      return;
    case S::kPregrasp:
      if (moves_ && arrived && is_open(input) && in_state_s_ >= motion_.settle_s) {
        take(LimbEvent::kDone);
      }
      return;
    case S::kClosing:
      return finish_closing(input);
    case S::kVerify:
      if (arrived) finish_pull(input);
      return;
    case S::kLoading:
      target_.weight = std::max(target_.weight, path_part());
      if (confirmation_.is_lost())
        take(LimbEvent::kLost);
      else if (arrived)
        take(LimbEvent::kDone);
      return;
    case S::kRegrasp:
      if (!held_on || !is_open(input)) return;
      if (num_tries_ < params_.max_tries && spent_s_ < params_.budget_s) {
        take(LimbEvent::kDone);
      } else if (home_ && !returned_) {
        take(LimbEvent::kGiveUp);
      } else {
        failed_ = true;  // it stands here, open, in front of a rung that does not hold
      }
      return;
    case S::kAbortReturn:
      return return_home(input);
    case S::kSupportLost:
      return;
  }
}

void LimbCycle::finish_closing(const LimbInput& input) {
  if (input.stop) return;
  if (confirmation_.witness().closed() && in_state_s_ >= motion_.close_s) {
    take(LimbEvent::kDone);
    return;
  }
  const bool is_empty = input.claw.jaw_rad <= claw_.closed_rad + params_.empty_window_rad;
  const bool is_late = in_state_s_ >= params_.close_timeout_s;
  if (is_late || (is_empty && in_state_s_ >= 2.0 * motion_.close_s)) {
    last_witness_ = confirmation_.witness();
    confirmation_.conclude_missed();
    take(LimbEvent::kMissed);
  }
}

void LimbCycle::finish_pull(const LimbInput& input) {
  const Eigen::Vector3d from_m = input.T_odom_body.inverse() * pulled_from_m_;
  const Eigen::Vector3d moved_m = kinematics_.foot_m(leg_, input.angles_rad) - from_m;
  // tau = -J^T f of the rung on the foot: the change since the pull began.
  const Eigen::Matrix3d J = kinematics_.jacobian(leg_, input.angles_rad);
  const LegAngles change_Nm = input.torques_Nm - torques_before_Nm_;
  const Eigen::Vector3d force_N = J.transpose().inverse() * change_Nm;
  last_witness_ = confirmation_.conclude({moved_m.z(), force_N.norm()});
  take(last_witness_.all() ? LimbEvent::kDone : LimbEvent::kMissed);
}

void LimbCycle::stay_home() {
  goal_ = home_.value_or(goal_);
  returned_ = true;
}

void LimbCycle::return_home(const LimbInput& input) {
  if (input.stop) return;
  const double duration_s = line_ ? line_->duration_s() : segment_.duration_s();
  const bool arrived = clock_.path_time_s() >= duration_s;
  if (stage_ == 0) {
    move_foot(goal_.pregrasp_m, motion_.retract_m_s);
    stage_ = 1;
  } else if (stage_ == 1 && arrived) {
    stay_home();
    num_tries_ = 0;
    move_foot(goal_.pregrasp_m, motion_.transit_m_s);
    stage_ = 2;
  } else if (stage_ == 2 && arrived) {
    take(LimbEvent::kDone);
  }
}

void LimbCycle::follow(const JointSample& sample, double rate) {
  if (state_ != S::kLoaded) return;
  target_.angles_rad = sample.angles_rad;
  target_.velocity_rad_s = rate * sample.velocity_rad_s;
  move_joints(sample.angles_rad, 0.0);
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
  if (state_ == S::kLoaded || state_ == S::kSupportLost) return false;
  const auto follow_path = [&](const auto& path) {
    clock_.advance(input.dt_s, input.stop, path, limits_);
    const JointSample sample = path.at(clock_.path_time_s());
    target_.angles_rad = sample.angles_rad;
    target_.velocity_rad_s = clock_.rate() * sample.velocity_rad_s;
    return clock_.path_time_s() >= path.duration_s() && !input.stop;
  };
  return line_ ? follow_path(*line_) : follow_path(segment_);
}

double LimbCycle::path_part() const {
  const double duration_s = line_ ? line_->duration_s() : segment_.duration_s();
  return duration_s > 0.0 ? std::min(1.0, clock_.path_time_s() / duration_s) : 1.0;
}

void LimbCycle::move_jaw(const LimbInput& input) {
  if (input.stop && !is_jaw_forced_) return;
  const double goal_rad = is_jaw_forced_ ? claw_.closed_rad : jaw_goal_rad_;
  const double step_rad = params_.jaw_speed_rad_s * input.dt_s;
  target_.jaw_rad += std::clamp(goal_rad - target_.jaw_rad, -step_rad, step_rad);
}

bool LimbCycle::is_open(const LimbInput& input) const {
  return input.claw.jaw_rad >= claw_.open_rad - kOpenWindow_rad;
}

Eigen::Vector3d LimbCycle::approach_offset_m() const {
  // The first try at the point itself, then a little to the left, then to the right.
  const double side = num_tries_ == 0 ? 0.0 : (num_tries_ % 2 == 1 ? 1.0 : -1.0);
  return {0.0, side * params_.try_offset_m, 0.0};
}

}  // namespace climb
