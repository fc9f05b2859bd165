// SPDX-License-Identifier: BSD-3-Clause
#include "climb/step_planner.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace climb {
namespace {

constexpr double kAhead_m = 0.10;  ///< less than half the distance of two rungs
constexpr double kUsualSpacing_m = 0.30;
constexpr double kRiseAtTop = 2.0;  ///< usual shifts of the body, to see what is above a gap
/// A docked claw stands in front of its rung: looking from so far below finds that one first.
constexpr double kLookFromBelow_m = 0.20;
constexpr double kRungBeside_m = 0.40;  ///< a rung reaches so far to either side of a claw on it
constexpr double kNextRung_m = 0.80;  ///< the next rung is at most so far above: two wide spacings
constexpr double kInLine_m = 0.10;    ///< the middle of a rung off the line through another's
constexpr double kInPlace_m = 0.008;  ///< a body so near to where a step wants it is not shifted
constexpr double kMaxSideways_m = 0.02;   ///< of one shift, across the ladder and out of it
constexpr double kStraight_rad = 0.02;    ///< a body so little askew is not turned
constexpr double kLeastSpread_m4 = 1e-6;  ///< of the feet, for a plane through them
constexpr double kMaxTurn_rad = 0.10;     ///< of one shift, about each axis

double height_m(const RungView& rung) {
  return 0.5 * (rung.end0_m.z() + rung.end1_m.z());
}

bool is_usable(const RungView& rung) {
  return rung.trusted && rung.end0_m.allFinite() && rung.end1_m.allFinite();
}

/// The body's attitude, in the body frame, in which it faces the plane of its feet with its head
/// up. Small angles: about y and x from the feet, about z from gravity.
Eigen::Matrix3d leveled(const PerLeg<Eigen::Vector3d>& feet_m, const Eigen::Vector3d& up_body) {
  Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& foot_m : feet_m) middle_m += 0.25 * foot_m;
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  Eigen::Vector2d products = Eigen::Vector2d::Zero();
  for (const Eigen::Vector3d& foot_m : feet_m) {
    const Eigen::Vector3d off_m = foot_m - middle_m;
    squares += off_m.head<2>() * off_m.head<2>().transpose();
    products += off_m.z() * off_m.head<2>();
  }
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  if (squares.determinant() > kLeastSpread_m4) slope = squares.inverse() * products;
  const auto small = [](double angle) { return std::clamp(angle, -kMaxTurn_rad, kMaxTurn_rad); };
  const double about_z = up_body.x() > 0.5 ? up_body.y() / up_body.x() : 0.0;
  return (Eigen::AngleAxisd(small(about_z), Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(small(-slope.x()), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(small(slope.y()), Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

double distance_m(const RungView& rung, const Eigen::Vector3d& point_m) {
  const Eigen::Vector3d along_m = rung.end1_m - rung.end0_m;
  const double length2 = along_m.squaredNorm();
  const double part = length2 > 0.0 ? along_m.dot(point_m - rung.end0_m) / length2 : 0.0;
  return (rung.end0_m + std::clamp(part, 0.0, 1.0) * along_m - point_m).norm();
}

}  // namespace

StepPlanner::StepPlanner(const ClimbParams& params)
    : params_(params),
      kinematics_(params.robot),
      support_(params.robot, params.support),
      choice_(params) {}

PlannedStep StepPlanner::dock(Leg leg, int avoid_rung_id, const RobotNow& now,
                              const LadderView& ladder) {
  GraspQuery query = query_of(leg, true, now);
  for (const Leg other : kLegs) query.held[other].holds = is_confirmed(now.limbs[other]);
  query.avoid_rung_id = avoid_rung_id;
  const Eigen::Vector3d here_m = query.from_m;
  query.from_m = docked_from_m(leg, now);
  const PlannedStep before_it = choose(query, now, ladder);
  if (before_it.ready || avoid_rung_id < 0) return before_it;
  // The rung that it was on gave way: the next one above it, or below.
  query.from_m = here_m;
  const PlannedStep above = choose(query, now, ladder);
  if (above.ready) return above;
  query.upwards = false;
  return choose(query, now, ladder);
}

PlannedStep StepPlanner::beside(const PlannedStep& refused, const RobotNow& now,
                                const LadderView& ladder) {
  const Leg other = mate_of(refused.leg);
  if (!is_confirmed(now.limbs[other])) return refused;
  GraspQuery query = query_of(refused.leg, true, now);
  const Eigen::Vector3d held_m = query.held[other].position_m;
  for (const RungView& seen : ladder.rungs) {
    if (seen.damaged && distance_m(seen, held_m) <= params_.grasp.same_rung_m) return refused;
  }
  const Eigen::Matrix3d R_odom_body = query.T_odom_body.linear();
  const Eigen::Vector3d side_m = kRungBeside_m * R_odom_body.col(1);
  RungView rung;
  rung.id = now.stance.contacts[other].rung_id;
  rung.trusted = true;
  rung.confidence = 1.0;
  rung.radius_m = params_.robot.claw.on_rung_radius_m;
  rung.end0_m = held_m + side_m;
  rung.end1_m = held_m - side_m;
  const StretchView stretch{0, 0.0, 2.0 * kRungBeside_m};
  query.from_m = held_m - kLookFromBelow_m * R_odom_body.col(0);
  const std::span rungs(&rung, 1);
  PlannedStep step = choose(query, now, {rungs, std::span(&stretch, 1), 0.0, true});
  step.goal.radius_m = 0.0;  // felt, not measured
  return step.ready ? step : refused;
}

Eigen::Vector3d StepPlanner::docked_from_m(Leg leg, const RobotNow& now) const {
  const Eigen::Vector3d below_m(-kLookFromBelow_m, 0.0, 0.0);
  const Eigen::Vector3d foot_m = kinematics_.foot_m(leg, now.stance.angles_rad[leg]);
  return now.pose.T_odom_body() * Eigen::Vector3d(foot_m + below_m);
}

void StepPlanner::remember_dock(const RobotNow& now) {
  const Eigen::Isometry3d T_odom_body = now.pose.T_odom_body();
  dock_feet_m_.emplace();
  for (const Leg leg : kLegs) {
    (*dock_feet_m_)[leg] = T_odom_body * kinematics_.foot_m(leg, now.stance.angles_rad[leg]);
  }
}

bool StepPlanner::is_at_dock(const RobotNow& now) const {
  if (!dock_feet_m_) return false;
  const Eigen::Isometry3d T_odom_body = now.pose.T_odom_body();
  for (const Leg leg : kLegs) {
    const Eigen::Vector3d foot_m =
        T_odom_body * kinematics_.foot_m(leg, now.stance.angles_rad[leg]);
    const double off_m = (foot_m - (*dock_feet_m_)[leg]).norm();
    if (!is_confirmed(now.limbs[leg]) || !(off_m <= params_.grasp.same_rung_m)) return false;
  }
  return true;
}

std::optional<LimbGoal> StepPlanner::put_down(Leg leg, const RobotNow& now,
                                              std::span<const LimbGoal> places) const {
  const Eigen::Vector3d foot_m = kinematics_.foot_m(leg, now.stance.angles_rad[leg]);
  std::optional<LimbGoal> nearest;
  for (const LimbGoal& place : places) {
    const LegSolution solution = kinematics_.inverse(leg, place.grasp_m);
    if (!solution.reachable()) continue;
    Stance stance = now.stance;
    stance.angles_rad[leg] = solution.angles_rad;
    stance.contacts[leg].weight = 1.0;
    if (!(support_.check(stance).margin >= 1.0)) continue;
    const bool is_nearer =
        !nearest || (place.grasp_m - foot_m).norm() < (nearest->grasp_m - foot_m).norm();
    if (is_nearer) nearest = place;
  }
  return nearest;
}

bool StepPlanner::offers(int rung_id, const Eigen::Vector3d& place_m,
                         const LadderView& ladder) const {
  for (const StretchView& stretch : ladder.stretches) {
    const bool is_known = stretch.rung_index >= 0 && stretch.rung_index < std::ssize(ladder.rungs);
    if (!is_known) continue;
    const RungView& rung = ladder.rungs[stretch.rung_index];
    if (rung.id != rung_id || !is_usable(rung) || rung.damaged) continue;
    const Eigen::Vector3d axis = (rung.end1_m - rung.end0_m).normalized();
    const double along_m = axis.dot(place_m - rung.end0_m);
    const double slack_m = params_.robot.claw.capture_m;
    const bool is_on_stretch =
        along_m >= stretch.from_m - slack_m && along_m <= stretch.to_m + slack_m;
    if (is_on_stretch && distance_m(rung, place_m) <= slack_m) return true;
  }
  return false;
}

bool StepPlanner::rests_safely(const RobotNow& now) const {
  Stance stance = now.stance;
  PerLeg<double> along_m;
  PerLeg<int> rung_ids;
  for (const Leg leg : kLegs) {
    if (!is_confirmed(now.limbs[leg])) return false;
    along_m[leg] = kinematics_.foot_m(leg, stance.angles_rad[leg]).x();
    // Feet of the same height share a rung, whatever number perception gave it.
    rung_ids[leg] = leg;
    for (int other = 0; other < leg; ++other) {
      const bool same = std::abs(along_m[leg] - along_m[other]) <= params_.grasp.same_rung_m;
      if (same) rung_ids[leg] = rung_ids[other];
    }
    stance.contacts[leg].rung_id = rung_ids[leg];
  }
  // Both rear claws on one rung would survive its loss, but with a drop of 70 mm (run).
  return is_staggered(rung_ids) && support_.check_rung_loss(stance).survives;
}

PlannedStep StepPlanner::next(bool upwards, bool may_shift, const RobotNow& now,
                              const LadderView& ladder) {
  PlannedStep step;
  step.leg = next_leg_of(upwards);
  if (has_stepped(step.leg, upwards, now)) {
    made(step.leg, upwards);
    step.leg = next_leg_of(upwards);
  }
  if (upwards && is_at_top(now, ladder)) {
    step.at_top = true;
    const double rise_m = kRiseAtTop * body_shift_m(spacing_m(ladder), upwards);
    if (may_shift) step.move = as_far_as_all_reach(body_move(rise_m, now), now);
    return step;
  }
  for (const Leg leg : kLegs) {
    if (!is_confirmed(now.limbs[leg])) return step;  // invariant 1: the three others hold
  }
  if (!upwards && is_at_dock(now)) {
    step.at_dock = true;
    if (may_shift) step.move = body_move(0.0, now);
    return step;
  }
  const SupportVerdict verdict = support_.check_without(now.stance, step.leg);
  if (!support_.is_ample(verdict)) {
    step.burden = verdict.burden == Burden::kBorne ? Burden::kGrip : verdict.burden;
    return step;
  }
  GraspQuery query = query_of(step.leg, upwards, now);
  const double ahead_m = body_shift_m(spacing_m(ladder), upwards);
  query.next_shift_m = ahead_m * query.T_odom_body.linear().col(0);
  BodyMove move;
  if (may_shift) move = as_far_as_all_reach(body_move(ahead_m, now), now);
  query.T_odom_body = query.T_odom_body * move.pose();
  PlannedStep chosen = choose(query, now, ladder);
  chosen.move = move;
  return chosen;
}

BodyMove StepPlanner::as_far_as_all_reach(const BodyMove& move, const RobotNow& now) const {
  for (const double part : {1.0, 0.8, 0.6, 0.4, 0.2}) {
    BodyMove shorter = move;
    shorter.shift_m *= part;
    const std::optional<Stance> stance = stance_after(shorter, now);
    if (stance && all_bend(*stance)) return shorter;
  }
  return {};
}

bool StepPlanner::all_bend(const Stance& stance) const {
  for (const Leg leg : kLegs) {
    const LegAngles& angles_rad = stance.angles_rad[leg];
    const double margin_rad = kinematics_.limit_margin_rad(leg, angles_rad);
    const double sigma_m = smallest_singular_value(kinematics_.jacobian(leg, angles_rad));
    const bool bends =
        margin_rad >= params_.grasp.min_joint_margin_rad && sigma_m >= params_.grasp.min_sigma_J_m;
    if (!bends) return false;
  }
  return true;
}

std::optional<Stance> StepPlanner::stance_after(const BodyMove& move, const RobotNow& now) const {
  const Eigen::Isometry3d T_moved_body = move.pose().inverse();
  Stance stance = now.stance;
  stance.up_body = T_moved_body.linear() * now.stance.up_body;
  for (const Leg leg : kLegs) {
    const Eigen::Vector3d foot_m = kinematics_.foot_m(leg, now.stance.angles_rad[leg]);
    const LegSolution solution = kinematics_.inverse(leg, T_moved_body * foot_m);
    if (!solution.reachable()) return std::nullopt;
    stance.angles_rad[leg] = solution.angles_rad;
  }
  return stance;
}

void StepPlanner::remember_vain(const Eigen::Vector3d& place_m) {
  vain_m_[num_vain_ % vain_m_.size()] = place_m;
  num_vain_ = std::min(num_vain_ + 1, vain_m_.size());
}

PlannedStep StepPlanner::again(const Retry& retry, const RobotNow& now, const LadderView& ladder) {
  GraspQuery query = query_of(retry.leg, retry.upwards, now);
  query.from_m = retry.from_m;
  query.is_long = (retry.tried_m - retry.from_m).norm() > params_.grasp.max_step_m;
  if (retry.where == Retry::Where::kOtherRung) {
    query.avoid_rung_id = retry.tried_rung_id;
  } else {
    query.only_rung_id = retry.tried_rung_id;
    if (retry.where == Retry::Where::kBeside) query.avoid_m = retry.tried_m;
  }
  return choose(query, now, ladder);
}

bool StepPlanner::has_stepped(Leg leg, bool upwards, const RobotNow& now) const {
  // A step that a stop interrupted is finished while arming: the other leg of the pair is behind.
  const Leg other = mate_of(leg);
  const double lead_m = kinematics_.foot_m(leg, now.stance.angles_rad[leg]).x() -
                        kinematics_.foot_m(other, now.stance.angles_rad[other]).x();
  return (upwards ? lead_m : -lead_m) > kAhead_m;
}

void StepPlanner::find_turn(const RobotNow& now) {
  // Upwards the right leg of a pair goes first, the rear pair before the front one.
  const bool is_rear_apart = has_stepped(kRearRight, true, now);
  const bool is_front_apart = has_stepped(kFrontRight, true, now);
  last_upwards_ = true;
  if (is_rear_apart)
    last_leg_ = is_front_apart ? kFrontRight : kRearRight;
  else
    last_leg_ = is_front_apart ? kRearLeft : kFrontLeft;
}

Leg StepPlanner::next_leg_of(bool upwards) const {
  return upwards == last_upwards_ ? next_leg(last_leg_, upwards) : last_leg_;
}

GraspQuery StepPlanner::query_of(Leg leg, bool upwards, const RobotNow& now) const {
  GraspQuery query;
  query.leg = leg;
  query.upwards = upwards;
  query.T_odom_body = now.pose.T_odom_body();
  for (const Leg other : kLegs) {
    const Eigen::Vector3d foot_m = kinematics_.foot_m(other, now.stance.angles_rad[other]);
    query.held[other] = {other != leg, query.T_odom_body * foot_m};
  }
  query.from_m = query.held[leg].position_m;
  query.vain_m = std::span(vain_m_).first(num_vain_);
  return query;
}

BodyMove StepPlanner::body_move(double ahead_m, const RobotNow& now) const {
  // Before a step the body is a quarter of the rungs' distance ahead of the middle of its feet and
  // looks straight up the ladder. Told from the feet, not summed up: whatever was interrupted,
  // sagged or turned is made good.
  PerLeg<Eigen::Vector3d> feet_m;
  Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();
  for (const Leg leg : kLegs) {
    feet_m[leg] = kinematics_.foot_m(leg, now.stance.angles_rad[leg]);
    middle_m += 0.25 * feet_m[leg];
  }
  const Eigen::Matrix3d R_body_level = leveled(feet_m, now.stance.up_body);
  // From the moved body the middle of the feet is behind and below.
  const Eigen::Vector3d seen_m(-ahead_m, 0.0, -params_.motion.stand_off_m);
  BodyMove move;
  move.turn = Eigen::Quaterniond(R_body_level);
  move.shift_m = middle_m - move.turn * seen_m;
  move.shift_m.y() = std::clamp(move.shift_m.y(), -kMaxSideways_m, kMaxSideways_m);
  move.shift_m.z() = std::clamp(move.shift_m.z(), -kMaxSideways_m, kMaxSideways_m);
  const bool is_in_place =
      move.shift_m.norm() <= kInPlace_m && move.turn.vec().norm() <= 0.5 * kStraight_rad;
  return is_in_place ? BodyMove() : move;
}

PlannedStep StepPlanner::choose(GraspQuery query, const RobotNow& now, const LadderView& ladder) {
  // Rungs are seen from this body, just now: what its odometry has lost since the start is theirs
  // too.
  query.body_sigma_m = std::min(now.pose.position_sigma_m, params_.odometry.anchor_sigma_m);
  const GraspDecision decision = choice_.choose(ladder, query);
  PlannedStep step;
  step.leg = query.leg;
  step.upwards = query.upwards;
  step.refusal = decision.refusal;
  step.ready = decision.refusal == Refusal::kNone;
  if (step.ready) {
    const Eigen::Isometry3d T_body_odom = query.T_odom_body.inverse();
    const GraspTarget& target = decision.target;
    step.joint_margin_rad = target.joint_margin_rad;
    step.goal = moved(T_body_odom, {target.rung_id, target.pregrasp_m, target.grasp_m,
                                    target.radius_m, target.rung_axis});
    step.goal.is_beyond = (target.grasp_m - query.from_m).norm() > params_.grasp.max_step_m;
  }
  return step;
}

double StepPlanner::spacing_m(const LadderView& ladder) const {
  double low_m = 0.0;
  double high_m = 0.0;
  int num_rungs = 0;
  for (const RungView& rung : ladder.rungs) {
    if (!is_usable(rung)) continue;
    low_m = num_rungs == 0 ? height_m(rung) : std::min(low_m, height_m(rung));
    high_m = num_rungs == 0 ? height_m(rung) : std::max(high_m, height_m(rung));
    ++num_rungs;
  }
  const double mean_m = num_rungs >= 2 ? (high_m - low_m) / (num_rungs - 1) : kUsualSpacing_m;
  const bool is_ladder = mean_m >= 0.21 && mean_m <= 0.42;  // one rung unseen would double it
  return is_ladder ? mean_m : kUsualSpacing_m;
}

bool StepPlanner::goes_on_above(const RungView& top, const RobotNow& now,
                                const LadderView& ladder) const {
  // What is seen above it, in line with the ladder, may be a rung that is not trusted just now.
  const Eigen::Vector3d up = now.pose.T_odom_body().linear().col(0);
  for (const RungView& rung : ladder.rungs) {
    if (!(rung.end0_m.allFinite() && rung.end1_m.allFinite())) continue;
    const Eigen::Vector3d off_m = 0.5 * (rung.end0_m + rung.end1_m - top.end0_m - top.end1_m);
    const double above_m = off_m.dot(up);
    const bool is_next = above_m >= params_.grasp.min_step_m && above_m <= kNextRung_m;
    if (is_next && (off_m - above_m * up).norm() <= kInLine_m) return true;
  }
  return false;
}

bool StepPlanner::is_at_top(const RobotNow& now, const LadderView& ladder) const {
  const RungView* top = nullptr;
  for (const RungView& rung : ladder.rungs) {
    if (is_usable(rung) && (top == nullptr || height_m(rung) > height_m(*top))) top = &rung;
  }
  if (top == nullptr || goes_on_above(*top, now, ladder)) return false;
  // By place, not by number: perception that starts anew counts its rungs anew.
  const Eigen::Isometry3d T_odom_body = now.pose.T_odom_body();
  for (const Leg leg : {kFrontLeft, kFrontRight}) {
    const Eigen::Vector3d foot_m = kinematics_.foot_m(leg, now.stance.angles_rad[leg]);
    const bool on_top = distance_m(*top, T_odom_body * foot_m) <= params_.grasp.same_rung_m;
    if (!is_confirmed(now.limbs[leg]) || !on_top) return false;
  }
  return true;
}

}  // namespace climb
