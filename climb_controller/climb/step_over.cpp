// SPDX-License-Identifier: BSD-3-Clause
// Where the crawl has no next step: from another place of the body, over a rung that is none to
// grasp, or another leg before it. Looked for a few places a cycle: all of them at once took longer
// than a cycle on a slow computer, and the drives stopped.
#include <algorithm>
#include <cmath>

#include "climb/step_planner.h"

namespace climb {
namespace {

using Stage = WaySearch::Stage;

constexpr double kFarthestPlace_m = 0.30;  ///< of the body from the middle of its feet
constexpr double kBetweenPlaces_m = 0.02;
constexpr double kWellWithin_rad = 0.4;  ///< of every joint limit: more is no better
/// Told angles are ahead of the measured ones by what the legs give way: a shift needs that much.
constexpr double kReserve_rad = 0.2;
constexpr double kUnusual_rad_m = 0.2;  ///< ... and so much less is as good, per metre nearer

/// Another place of the body, or the next rung but one, may be the answer.
bool may_be_another_way(const PlannedStep& refused) {
  switch (refused.refusal) {
    case Refusal::kNotFinite:
    case Refusal::kStale:
    case Refusal::kNoLadder:
    case Refusal::kNotAhead:
      return false;
    case Refusal::kNone:
      return refused.burden != Burden::kBorne;
    default:
      return true;
  }
}

}  // namespace

std::optional<PlannedStep> StepPlanner::over(const PlannedStep& refused, bool may_shift,
                                             const RobotNow& now, const LadderView& ladder) {
  if (refused.ready || refused.at_top || !may_be_another_way(refused)) {
    forget_way();
    return refused;
  }
  if (way_.stage == Stage::kNone) look_for(Stage::kStep, refused, may_shift);
  for (int i = 0; i < kPlacesACycle; ++i) {
    const bool is_then = way_.stage == Stage::kStepThen || way_.stage == Stage::kMateThen;
    look_from(way_.place++ * kBetweenPlaces_m, is_then ? way_.then : now, ladder);
    if (way_.place <= way_.num_places) continue;
    if (const std::optional<PlannedStep> answer = conclude(refused, may_shift, now)) {
      forget_way();
      return answer;
    }
  }
  return std::nullopt;
}

void StepPlanner::look_for(Stage stage, const PlannedStep& wanted, bool may_shift) {
  way_.stage = stage;
  way_.num_places = may_shift ? static_cast<int>(kFarthestPlace_m / kBetweenPlaces_m) : 0;
  way_.place = -way_.num_places;
  way_.best = wanted;
  way_.best_worth = 0.0;
}

std::optional<PlannedStep> StepPlanner::conclude(const PlannedStep& refused, bool may_shift,
                                                 const RobotNow& now) {
  const PlannedStep best = way_.best;
  switch (way_.stage) {
    case Stage::kNone:
      break;
    case Stage::kStep: {
      if (best.ready) return best;
      // The other pair spreads over too many rungs: its leg that is behind goes first, if that
      // helps.
      PlannedStep first = refused;
      first.leg = is_front(refused.leg) ? kRearLeft : kFrontLeft;
      if (has_stepped(first.leg, refused.upwards, now)) first.leg = mate_of(first.leg);
      if (!has_stepped(mate_of(first.leg), refused.upwards, now)) break;
      look_for(Stage::kFirst, first, may_shift);
      return std::nullopt;
    }
    case Stage::kFirst: {
      const std::optional<Stance> moved = stance_after(best.move, now);
      if (!best.ready || !moved) break;
      way_.first = best;
      way_.then = after_step(best, *moved, now);
      look_for(Stage::kStepThen, refused, true);
      return std::nullopt;
    }
    case Stage::kStepThen: {
      if (!best.ready) break;
      PlannedStep mate = refused;
      mate.leg = mate_of(refused.leg);
      look_for(Stage::kMateThen, mate, true);
      return std::nullopt;
    }
    case Stage::kMateThen:
      if (best.ready) return way_.first;
      break;
  }
  return refused;
}

RobotNow StepPlanner::after_step(const PlannedStep& step, const Stance& moved,
                                 const RobotNow& now) const {
  RobotNow then = now;
  then.stance = moved;
  then.stance.angles_rad[step.leg] = kinematics_.inverse(step.leg, step.goal.grasp_m).angles_rad;
  const Eigen::Isometry3d T_odom_moved = now.pose.T_odom_body() * step.move.pose();
  then.pose.position_odom_m = T_odom_moved.translation();
  then.pose.q_odom_body = Eigen::Quaterniond(T_odom_moved.linear());
  return then;
}

void StepPlanner::look_from(double ahead_m, const RobotNow& now, const LadderView& ladder) {
  // A leg reaches as far ahead as behind: between its old and its new rung the body goes, near its
  // usual place where all legs reach well from there.
  PlannedStep& best = way_.best;
  BodyMove move;
  if (way_.num_places > 0) move = body_move(ahead_m, now);
  const std::optional<Stance> stance = stance_after(move, now);
  if (!stance) return;
  GraspQuery query = query_of(best.leg, best.upwards, now);
  query.is_long = true;
  query.T_odom_body = query.T_odom_body * move.pose();
  PlannedStep step = choose(query, now, ladder);
  if (!step.ready) return;
  double margin_rad = std::min(step.joint_margin_rad, kWellWithin_rad);
  for (const Leg leg : kLegs) {
    const LegAngles& angles_rad = stance->angles_rad[leg];
    margin_rad = std::min(margin_rad, kinematics_.limit_margin_rad(leg, angles_rad));
  }
  const double usual_m = body_shift_m(spacing_m(ladder), best.upwards);
  const double worth = margin_rad - kUnusual_rad_m * std::abs(ahead_m - usual_m);
  const bool is_within = move.is_none() || margin_rad >= kReserve_rad;
  if (!is_within || !all_bend(*stance) || (best.ready && worth <= way_.best_worth)) return;
  const SupportVerdict verdict = support_.check_without(*stance, best.leg);
  if (!support_.is_ample(verdict)) return;
  best = step;
  best.move = move;
  way_.best_worth = worth;
}

}  // namespace climb
