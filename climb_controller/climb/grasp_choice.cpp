// SPDX-License-Identifier: BSD-3-Clause
#include "climb/grasp_choice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Eigenvalues>

namespace climb {
namespace {

constexpr double kMaxFrameError = 1e-3;
constexpr double kMinAcross = 0.5;        ///< a rung lies across the body: cosine to the body's y
constexpr double kAmpleMargin_rad = 0.5;  ///< more joint margin than this costs no less

bool finite(const RungView& rung) {
  return rung.end0_m.allFinite() && rung.end1_m.allFinite() && rung.covariance_m2.allFinite() &&
         std::isfinite(rung.radius_m) && std::isfinite(rung.confidence);
}

bool finite(const GraspQuery& query) {
  if (!query.T_odom_body.matrix().allFinite() || !query.next_shift_m.allFinite()) return false;
  if (query.avoid_m && !query.avoid_m->allFinite()) return false;
  if (!query.from_m.allFinite() || !(query.body_sigma_m >= 0.0)) return false;
  const Eigen::Matrix3d R = query.T_odom_body.linear();
  if (!((R * R.transpose() - Eigen::Matrix3d::Identity()).norm() <= kMaxFrameError)) return false;
  for (const HeldPoint& held : query.held) {
    if (held.holds && !held.position_m.allFinite()) return false;
  }
  return true;
}

/// Largest standard deviation across `axis`.
double sigma_across_m(const Eigen::Matrix3d& covariance_m2, const Eigen::Vector3d& axis) {
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - axis * axis.transpose();
  const Eigen::Matrix3d symmetric = 0.5 * (covariance_m2 + covariance_m2.transpose());
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.compute(across * symmetric * across, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()[2]));
}

struct Interval {
  double low_m = 0.0;
  double high_m = 0.0;
};

/// The two parts of `whole` beside `hole`; without a hole the whole twice.
std::array<Interval, 2> without(const std::optional<Interval>& hole, const Interval& whole) {
  if (!hole) return {whole, whole};
  return {Interval{whole.low_m, std::min(whole.high_m, hole->low_m)},
          Interval{std::max(whole.low_m, hole->high_m), whole.high_m}};
}

Eigen::Vector3d in_body(const GraspQuery& query, const Eigen::Vector3d& point_odom_m) {
  return query.T_odom_body.linear().transpose() * (point_odom_m - query.T_odom_body.translation());
}

}  // namespace

const char* name(Refusal refusal) {
  constexpr std::array<const char*, kNumRefusals> kNames = {"none",
                                                            "not finite",
                                                            "stale",
                                                            "no ladder",
                                                            "avoided",
                                                            "not trusted",
                                                            "damaged",
                                                            "low confidence",
                                                            "radius",
                                                            "uncertain",
                                                            "not ahead",
                                                            "too far ahead",
                                                            "no stretch",
                                                            "stretch too short",
                                                            "too far sideways",
                                                            "occupied",
                                                            "pregrasp out of reach",
                                                            "approach out of reach",
                                                            "grasp out of reach",
                                                            "out of reach after the body shift",
                                                            "joint margin",
                                                            "singular",
                                                            "rung missing"};
  const auto index = static_cast<std::size_t>(refusal);
  return index < kNames.size() ? kNames[index] : "?";
}

GraspChoice::GraspChoice(const ClimbParams& params, int max_rungs)
    : kinematics_(params.robot),
      motion_(params.motion),
      claw_(params.robot.claw),
      params_(params.grasp),
      max_rungs_(max_rungs) {
  decisions_.reserve(static_cast<std::size_t>(std::max(0, max_rungs)));
}

GraspDecision GraspChoice::choose(const LadderView& ladder, const GraspQuery& query) {
  decisions_.clear();
  GraspDecision decision;
  if (!finite(query)) {
    decision.refusal = Refusal::kNotFinite;
  } else if (!(ladder.age_s >= 0.0 && ladder.age_s <= params_.max_age_s)) {
    decision.refusal = Refusal::kStale;
  } else if (ladder.confirmed) {
    const int num_rungs = std::min(static_cast<int>(ladder.rungs.size()), max_rungs_);
    bool is_any_within = false;
    for (int i = 0; i < num_rungs; ++i) {
      GraspTarget target;
      const Refusal refusal = judge(ladder, i, query, target);
      decisions_.push_back({ladder.rungs[i].id, refusal});
      if (refusal == Refusal::kNone) {
        const GraspTarget& best = decision.target;
        const bool cheaper = target.cost_m < best.cost_m ||
                             (target.cost_m == best.cost_m && target.rung_id < best.rung_id);
        if (decision.refusal != Refusal::kNone || cheaper) decision.target = target;
        decision.refusal = Refusal::kNone;
      } else if (decision.refusal != Refusal::kNone) {
        // Why the rung that it should be is none; the others were never meant. Of several the one
        // that came furthest: checks run in this order.
        const bool is_within = is_within_step(ladder.rungs[i], query);
        if (is_within && !is_any_within) decision.refusal = refusal;
        if (is_within == is_any_within) decision.refusal = std::max(decision.refusal, refusal);
        is_any_within = is_any_within || is_within;
      }
    }
    if (decision.refusal != Refusal::kNone && lacks_rung(ladder, query)) {
      decision.refusal = Refusal::kRungMissing;
    }
  }
  decision.rungs = decisions_;
  return decision;
}

Refusal GraspChoice::judge(const LadderView& ladder, int rung_index, const GraspQuery& query,
                           GraspTarget& target) const {
  const RungView& rung = ladder.rungs[rung_index];
  target.rung_id = rung.id;
  Refusal refusal = judge_rung(rung, query, target);
  if (refusal == Refusal::kNone) refusal = place(ladder, rung_index, query, target);
  if (refusal == Refusal::kNone) refusal = judge_place(query, target);
  double joint_margin_rad = std::numeric_limits<double>::infinity();
  if (refusal == Refusal::kNone) refusal = judge_reach(query, target, joint_margin_rad);
  if (refusal == Refusal::kNone) target.cost_m = cost_m(rung, query, target, joint_margin_rad);
  target.joint_margin_rad = joint_margin_rad;
  return refusal;
}

double GraspChoice::step_to_m(const RungView& rung, const GraspQuery& query) {
  const Eigen::Vector3d ahead = (query.upwards ? 1.0 : -1.0) * query.T_odom_body.linear().col(0);
  return ahead.dot(0.5 * (rung.end0_m + rung.end1_m) - query.from_m);
}

bool GraspChoice::is_within_step(const RungView& rung, const GraspQuery& query) const {
  const double step = step_to_m(rung, query);
  return step >= params_.min_step_m && step <= params_.max_step_m;
}

bool GraspChoice::is_vain(const RungView& rung, const GraspQuery& query) const {
  const Eigen::Vector3d axis = (rung.end1_m - rung.end0_m).normalized();
  for (const Eigen::Vector3d& vain_m : query.vain_m) {
    const Eigen::Vector3d off_m = vain_m - rung.end0_m;
    if ((off_m - off_m.dot(axis) * axis).norm() <= params_.same_rung_m) return true;
  }
  return false;
}

bool GraspChoice::lacks_rung(const LadderView& ladder, const GraspQuery& query) const {
  // Rungs are less than a step apart: where the next one is not, another one was.
  bool goes_on = false;
  for (const RungView& rung : ladder.rungs) {
    const double step = step_to_m(rung, query);
    if (is_within_step(rung, query)) return false;
    goes_on = goes_on || (step > params_.max_step_m && step <= 2.0 * params_.max_step_m);
  }
  return goes_on;
}

Refusal GraspChoice::judge_rung(const RungView& rung, const GraspQuery& query,
                                GraspTarget& target) const {
  if (!finite(rung)) return Refusal::kNotFinite;
  const bool is_other = query.only_rung_id >= 0 && rung.id != query.only_rung_id;
  const bool is_avoided = rung.id == query.avoid_rung_id || is_vain(rung, query);
  if (is_avoided || is_other) return Refusal::kAvoided;
  if (!rung.trusted) return Refusal::kNotTrusted;
  if (rung.damaged) return Refusal::kDamaged;
  if (!(rung.confidence >= params_.min_confidence)) return Refusal::kLowConfidence;
  if (!(rung.radius_m >= claw_.min_rung_radius_m && rung.radius_m <= claw_.max_rung_radius_m)) {
    return Refusal::kRadius;
  }
  const Eigen::Vector3d along_m = rung.end1_m - rung.end0_m;
  if (!(along_m.norm() > claw_.width_m)) return Refusal::kStretchTooShort;
  target.rung_axis = along_m.normalized();
  target.radius_m = rung.radius_m;
  target.sigma_m =
      std::hypot(sigma_across_m(rung.covariance_m2, target.rung_axis), query.body_sigma_m);
  if (!(target.sigma_m <= params_.max_sigma_m)) return Refusal::kUncertain;

  const double step = step_to_m(rung, query);
  if (!(step >= params_.min_step_m)) return Refusal::kNotAhead;
  return step <= longest_step_m(query) ? Refusal::kNone : Refusal::kTooFarAhead;
}

Refusal GraspChoice::place(const LadderView& ladder, int rung_index, const GraspQuery& query,
                           GraspTarget& target) const {
  const RungView& rung = ladder.rungs[rung_index];
  const Eigen::Vector3d left = query.T_odom_body.linear().col(1);
  const double leftward = target.rung_axis.dot(left);
  if (!(std::abs(leftward) >= kMinAcross)) return Refusal::kTooFarSideways;
  const double home_m = lateral_sign(query.leg) * motion_.lateral_home_m;
  const double wish_m = (home_m - in_body(query, rung.end0_m).y()) / leftward;

  std::optional<Interval> tried;
  if (query.avoid_m) {
    const double tried_m = target.rung_axis.dot(*query.avoid_m - rung.end0_m);
    tried = {tried_m - params_.retry_distance_m, tried_m + params_.retry_distance_m};
  }
  const double half_m = 0.5 * claw_.width_m + params_.claw_margin_m;
  bool any_stretch = false;
  std::optional<double> best_m;
  for (const StretchView& stretch : ladder.stretches) {
    if (stretch.rung_index != rung_index) continue;
    any_stretch = true;
    const double low_m = stretch.from_m + half_m;
    const double high_m = stretch.to_m - half_m;
    if (!(low_m <= high_m + 1e-9)) continue;  // false for NaN; just wide enough is enough
    for (const Interval& part : without(tried, {low_m, high_m})) {
      if (!(part.low_m <= part.high_m + 1e-9)) continue;
      const double here_m = std::max(part.low_m, std::min(wish_m, part.high_m));
      if (!best_m || std::abs(here_m - wish_m) < std::abs(*best_m - wish_m)) best_m = here_m;
    }
  }
  if (!any_stretch) return Refusal::kNoStretch;
  if (!best_m) return Refusal::kStretchTooShort;
  target.grasp_m = rung.end0_m + *best_m * target.rung_axis;
  if (!target.grasp_m.allFinite()) return Refusal::kNotFinite;

  // A claw comes to its rung, as it leaves it, along its own opening: straight at the ladder a
  // finger would meet the rung where the shank stands aslant.
  const LegSolution there = kinematics_.inverse(query.leg, in_body(query, target.grasp_m));
  if (!there.reachable()) return Refusal::kGraspOutOfReach;
  target.pregrasp_m =
      target.grasp_m +
      motion_.pregrasp_m *
          (query.T_odom_body.linear() * kinematics_.retract_direction(query.leg, there.angles_rad));
  if (leftward < 0.0) target.rung_axis = -target.rung_axis;
  return Refusal::kNone;
}

Refusal GraspChoice::judge_place(const GraspQuery& query, const GraspTarget& target) const {
  const double home_m = lateral_sign(query.leg) * motion_.lateral_home_m;
  const double off_m = std::abs(in_body(query, target.grasp_m).y() - home_m);
  if (!(off_m <= params_.max_lateral_m)) return Refusal::kTooFarSideways;
  for (const Leg leg : kLegs) {
    const HeldPoint& held = query.held[leg];
    if (leg == query.leg || !held.holds) continue;
    if (!((held.position_m - target.grasp_m).norm() >= params_.claw_clearance_m)) {
      return Refusal::kOccupied;
    }
  }
  return Refusal::kNone;
}

Refusal GraspChoice::judge_posture(const GraspQuery& query, const LegAngles& angles_rad,
                                   double& joint_margin_rad) const {
  const double margin_rad = kinematics_.limit_margin_rad(query.leg, angles_rad);
  joint_margin_rad = std::min(joint_margin_rad, margin_rad);
  if (!(margin_rad >= params_.min_joint_margin_rad)) return Refusal::kJointMargin;
  const double sigma_m = smallest_singular_value(kinematics_.jacobian(query.leg, angles_rad));
  return sigma_m >= params_.min_sigma_J_m ? Refusal::kNone : Refusal::kSingular;
}

Refusal GraspChoice::judge_reach(const GraspQuery& query, const GraspTarget& target,
                                 double& joint_margin_rad) const {
  const Eigen::Vector3d grasp_m = in_body(query, target.grasp_m);
  const Eigen::Vector3d pregrasp_m = in_body(query, target.pregrasp_m);
  const int last = params_.num_approach_points + 1;
  Refusal posture = Refusal::kNone;
  for (int i = 0; i <= last + 1; ++i) {
    const bool shifted = i == last + 1;
    const double part = std::min(1.0, double(i) / last);
    const Eigen::Vector3d point_m =
        shifted ? in_body(query, target.grasp_m - query.next_shift_m)
                : Eigen::Vector3d(pregrasp_m + part * (grasp_m - pregrasp_m));
    const LegSolution solution = kinematics_.inverse(query.leg, point_m);
    if (!solution.reachable()) {
      if (shifted) return Refusal::kShiftOutOfReach;
      if (i == 0) return Refusal::kPregraspOutOfReach;
      return i == last ? Refusal::kGraspOutOfReach : Refusal::kApproachOutOfReach;
    }
    if (posture == Refusal::kNone) {
      posture = judge_posture(query, solution.angles_rad, joint_margin_rad);
    }
  }
  return posture;
}

double GraspChoice::cost_m(const RungView& rung, const GraspQuery& query, const GraspTarget& target,
                           double joint_margin_rad) const {
  const double home_m = lateral_sign(query.leg) * motion_.lateral_home_m;
  const double lateral_m = std::abs(in_body(query, target.grasp_m).y() - home_m);
  const double step_m =
      std::abs(query.T_odom_body.linear().col(0).dot(target.grasp_m - query.from_m));
  const double lacking_margin = 1.0 - std::clamp(joint_margin_rad / kAmpleMargin_rad, 0.0, 1.0);
  return params_.lateral_cost * lateral_m +
         params_.step_cost * std::max(0.0, step_m - params_.min_step_m) +
         params_.sigma_cost * target.sigma_m +
         params_.confidence_cost_m * (1.0 - std::clamp(rung.confidence, 0.0, 1.0)) +
         params_.margin_cost_m * lacking_margin;
}

}  // namespace climb
