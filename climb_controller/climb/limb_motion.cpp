// SPDX-License-Identifier: BSD-3-Clause
// How a limb's targets move: along its path, its jaw at its pace, and how hard it pulls.
#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "climb/limb_cycle.h"

namespace climb {
namespace {

constexpr double kOpenWindow_rad = 0.1;

bool in(double value, double low, double high) {  // false for NaN
  return value >= low && value <= high;
}

}  // namespace

std::string check(const LimbParams& p) {
  if (!in(p.jaw_speed_rad_s, 0.1, 100.0)) return "limb.jaw_speed_rad_s must be 0.1..100";
  const bool times_ok = in(p.close_timeout_s, 0.1, 60.0) && in(p.open_timeout_s, 0.1, 60.0) &&
                        in(p.others_timeout_s, 0.0, 60.0) && in(p.budget_s, 0.1, 600.0);
  if (!times_ok) {
    return "limb: close_timeout_s and open_timeout_s must be 0.1..60, others_timeout_s 0..60, "
           "budget_s 0.1..600";
  }
  if (!(p.max_tries >= 1 && p.max_tries_elsewhere >= 1)) {
    return "limb: max_tries and max_tries_elsewhere must be above 0";
  }
  if (!in(p.try_offset_m, 0.0, 0.1)) return "limb.try_offset_m must be 0..0.1";
  if (!in(p.empty_window_rad, 0.0, 1.0)) return "limb.empty_window_rad must be 0..1";
  return "";
}

void LimbCycle::follow(const JointSample& sample, double rate) {
  if (state_ != LimbState::kLoaded) return;
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

double LimbCycle::pull_N(const LimbInput& input) const {
  // tau = -J^T f of the rung on the foot: the change since the claw began to close.
  const Eigen::Matrix3d J = kinematics_.jacobian(leg_, input.angles_rad);
  const LegAngles change_Nm = input.torques_Nm - torques_before_Nm_;
  return (J.transpose().inverse() * change_Nm).norm();
}

Eigen::Vector3d LimbCycle::approach_offset_m() const {
  // The first try at the point itself, then a little to the left, then to the right.
  const double side = num_tries_ == 0 ? 0.0 : (num_tries_ % 2 == 1 ? 1.0 : -1.0);
  return {0.0, side * params_.try_offset_m, 0.0};
}

}  // namespace climb
