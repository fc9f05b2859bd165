// SPDX-License-Identifier: BSD-3-Clause
// Where the crawl has no next step: from another place of the body, over a rung that is none to
// grasp, or another leg before it.
#include <algorithm>
#include <cmath>

#include "climb/step_planner.h"

namespace climb {
namespace {

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

PlannedStep StepPlanner::over(const PlannedStep& refused, bool may_shift, const RobotNow& now,
                              const LadderView& ladder) {
  if (refused.ready || refused.at_top || !may_be_another_way(refused)) return refused;
  const PlannedStep step = from_best_place(refused, may_shift, now, ladder);
  if (step.ready) return step;
  // The other pair spreads over too many rungs: its leg that is behind goes first, if that helps.
  PlannedStep first = refused;
  first.leg = is_front(refused.leg) ? kRearLeft : kFrontLeft;
  if (has_stepped(first.leg, refused.upwards, now)) first.leg = mate_of(first.leg);
  if (!has_stepped(mate_of(first.leg), refused.upwards, now)) return refused;
  first = from_best_place(first, may_shift, now, ladder);
  const std::optional<Stance> moved = stance_after(first.move, now);
  if (!first.ready || !moved) return refused;
  RobotNow then = now;
  then.stance = *moved;
  then.stance.angles_rad[first.leg] = kinematics_.inverse(first.leg, first.goal.grasp_m).angles_rad;
  const Eigen::Isometry3d T_odom_moved = now.pose.T_odom_body() * first.move.pose();
  then.pose.position_odom_m = T_odom_moved.translation();
  then.pose.q_odom_body = Eigen::Quaterniond(T_odom_moved.linear());
  PlannedStep mate = refused;
  mate.leg = mate_of(refused.leg);
  const bool helps = from_best_place(refused, true, then, ladder).ready &&
                     from_best_place(mate, true, then, ladder).ready;
  return helps ? first : refused;
}

PlannedStep StepPlanner::from_best_place(const PlannedStep& refused, bool may_shift,
                                         const RobotNow& now, const LadderView& ladder) {
  const GraspQuery here = query_of(refused.leg, refused.upwards, now);
  const double usual_m = body_shift_m(spacing_m(ladder), refused.upwards);
  PlannedStep best = refused;
  double best_worth = 0.0;
  // A leg reaches as far ahead as behind: between its old and its new rung the body goes, near its
  // usual place where all legs reach well from there.
  const int num_places = may_shift ? static_cast<int>(kFarthestPlace_m / kBetweenPlaces_m) : 0;
  for (int place = -num_places; place <= num_places; ++place) {
    const double ahead_m = place * kBetweenPlaces_m;
    BodyMove move;
    if (may_shift) move = body_move(ahead_m, now);
    const std::optional<Stance> stance = stance_after(move, now);
    if (!stance) continue;
    GraspQuery query = here;
    query.is_long = true;
    query.T_odom_body = here.T_odom_body * move.pose();
    PlannedStep step = choose(query, now, ladder);
    if (!step.ready) continue;
    double margin_rad = std::min(step.joint_margin_rad, kWellWithin_rad);
    for (const Leg leg : kLegs) {
      const LegAngles& angles_rad = stance->angles_rad[leg];
      margin_rad = std::min(margin_rad, kinematics_.limit_margin_rad(leg, angles_rad));
    }
    const double worth = margin_rad - kUnusual_rad_m * std::abs(ahead_m - usual_m);
    const bool is_within = move.is_none() || margin_rad >= kReserve_rad;
    if (!is_within || !all_bend(*stance) || (best.ready && worth <= best_worth)) continue;
    const SupportVerdict verdict = support_.check_without(*stance, refused.leg);
    if (!support_.is_ample(verdict)) continue;
    best = step;
    best.move = move;
    best_worth = worth;
  }
  return best;
}

}  // namespace climb
