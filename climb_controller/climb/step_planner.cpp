// SPDX-License-Identifier: BSD-3-Clause
#include "climb/step_planner.h"

#include <algorithm>

namespace climb {
namespace {

constexpr double kUsualSpacing_m = 0.30;
/// A docked claw stands in front of its rung: looking from so far below finds that one first.
constexpr double kLookFromBelow_m = 0.20;
constexpr double kMaxCentring_m = 0.02;  ///< in one body shift

double height_m(const RungView& rung) {
  return 0.5 * (rung.end0_m.z() + rung.end1_m.z());
}

}  // namespace

StepPlanner::StepPlanner(const ClimbParams& params)
    : params_(params),
      kinematics_(params.robot),
      support_(params.robot, params.support),
      choice_(params) {}

PlannedStep StepPlanner::dock(Leg leg, const RobotNow& now, const LadderView& ladder) {
  GraspQuery query;
  query.leg = leg;
  query.T_odom_body = now.pose.T_odom_body();
  const Eigen::Vector3d foot_m = kinematics_.foot_m(leg, now.stance.angles_rad[leg]);
  query.from_m = query.T_odom_body * foot_m -
                 kLookFromBelow_m * (query.T_odom_body.linear() * Eigen::Vector3d::UnitX());
  return choose(query, now, ladder);
}

PlannedStep StepPlanner::next(bool upwards, bool shifted, const RobotNow& now,
                              const LadderView& ladder) {
  PlannedStep step;
  step.leg = next_leg(last_leg_, upwards);
  if (upwards && is_at_top(now, ladder)) {
    step.at_top = true;
    return step;
  }
  for (const Leg leg : kLegs) {
    if (!is_confirmed(now.limbs[leg])) return step;  // invariant 1: the three others hold
  }
  const SupportVerdict verdict = support_.check_without(now.stance, step.leg);
  if (!(verdict.margin >= params_.support.min_margin)) {
    step.burden = verdict.burden == Burden::kBorne ? Burden::kGrip : verdict.burden;
    return step;
  }
  const Eigen::Vector3d along_body(body_shift_m(spacing_m(ladder), upwards), 0.0, 0.0);
  GraspQuery query;
  query.leg = step.leg;
  query.upwards = upwards;
  query.T_odom_body = now.pose.T_odom_body();
  const Eigen::Vector3d foot_m = kinematics_.foot_m(step.leg, now.stance.angles_rad[step.leg]);
  query.from_m = query.T_odom_body * foot_m;
  for (const Leg leg : kLegs) {
    const Eigen::Vector3d held_m = kinematics_.foot_m(leg, now.stance.angles_rad[leg]);
    query.held[leg] = {leg != step.leg, query.T_odom_body * held_m};
  }
  query.next_shift_m = query.T_odom_body.linear() * along_body;
  const Eigen::Vector3d shift_body = along_body + centring_m(now);
  if (!shifted) query.T_odom_body.pretranslate(query.T_odom_body.linear() * shift_body);
  PlannedStep chosen = choose(query, now, ladder);
  chosen.shift_m = shifted ? Eigen::Vector3d::Zero() : shift_body;
  return chosen;
}

Eigen::Vector3d StepPlanner::centring_m(const RobotNow& now) const {
  // Each pull test draws the body a little towards the ladder.
  Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();
  for (const Leg leg : kLegs) {
    middle_m += kinematics_.foot_m(leg, now.stance.angles_rad[leg]) / kNumLegs;
  }
  const double out_m = middle_m.z() + params_.motion.stand_off_m;
  return {0.0, std::clamp(middle_m.y(), -kMaxCentring_m, kMaxCentring_m),
          std::clamp(out_m, -kMaxCentring_m, kMaxCentring_m)};
}

PlannedStep StepPlanner::choose(GraspQuery query, const RobotNow& now, const LadderView& ladder) {
  query.body_sigma_m = now.pose.position_sigma_m;
  const GraspDecision decision = choice_.choose(ladder, query);
  PlannedStep step;
  step.leg = query.leg;
  step.refusal = decision.refusal;
  step.ready = decision.refusal == Refusal::kNone;
  if (step.ready) {
    const Eigen::Isometry3d T_body_odom = query.T_odom_body.inverse();
    step.goal = {decision.target.rung_id, T_body_odom * decision.target.pregrasp_m,
                 T_body_odom * decision.target.grasp_m};
  }
  return step;
}

double StepPlanner::spacing_m(const LadderView& ladder) const {
  double low_m = 0.0;
  double high_m = 0.0;
  int num_rungs = 0;
  for (const RungView& rung : ladder.rungs) {
    if (!rung.trusted) continue;
    low_m = num_rungs == 0 ? height_m(rung) : std::min(low_m, height_m(rung));
    high_m = num_rungs == 0 ? height_m(rung) : std::max(high_m, height_m(rung));
    ++num_rungs;
  }
  const double mean_m = num_rungs >= 2 ? (high_m - low_m) / (num_rungs - 1) : kUsualSpacing_m;
  const bool is_ladder = mean_m >= 0.21 && mean_m <= 0.42;  // one rung unseen would double it
  return is_ladder ? mean_m : kUsualSpacing_m;
}

bool StepPlanner::is_at_top(const RobotNow& now, const LadderView& ladder) const {
  const RungView* top = nullptr;
  for (const RungView& rung : ladder.rungs) {
    if (rung.trusted && (top == nullptr || height_m(rung) > height_m(*top))) top = &rung;
  }
  if (top == nullptr) return false;
  return now.stance.contacts[kFrontLeft].rung_id == top->id &&
         now.stance.contacts[kFrontRight].rung_id == top->id;
}

}  // namespace climb
