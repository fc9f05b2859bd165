// SPDX-License-Identifier: BSD-3-Clause
#include "ladder/affordance.h"

#include <algorithm>
#include <cmath>

#include "ladder/axis.h"

namespace ladder {
namespace {

double length_m(const Rung& rung) {
  return std::sqrt((rung.end1_m - rung.end0_m).squaredNorm());
}

}  // namespace

Affordance::Affordance(const LadderParams& params) : params_(params.affordance) {
  samples_.reserve(static_cast<std::size_t>(params_.max_length_m / params_.step_m) + 2);
  blocked_.reserve(4 + params.max_bars + 2 * static_cast<std::size_t>(params.max_tracks));
}

void Affordance::find(std::span<const RungSurface> surfaces, std::span<const RailLine> rails,
                      const Eigen::Vector3d& body_m, LadderEstimate& estimate) {
  estimate.intervals.clear();
  estimate.grasps.clear();
  for (int i = 0; i < static_cast<int>(estimate.rungs.size()); ++i) {
    const Rung& rung = estimate.rungs[i];
    const unsigned damage = rung.flags & (kFlagStub | kFlagBent | kFlagSagged);
    Reason whole = Reason::kNone;
    if (rung.state != RungState::kTrusted || !surfaces[i].may_be_offered) {
      whole = Reason::kNotTrusted;
    } else if (damage != 0 || surfaces[i].tilt_sin > params_.max_tilt_sin) {
      whole = Reason::kDamaged;
    } else if (surfaces[i].is_tread) {
      whole = Reason::kTooDeep;
    } else if (length_m(rung) < params_.gripper_width_m) {
      whole = Reason::kTooShort;
    }
    if (whole != Reason::kNone) {
      estimate.intervals.push_back({i, 0.0, length_m(rung), whole});
      continue;
    }
    sample(estimate, i, surfaces[i], rails);
    offer(i, body_m, estimate);
  }
}

void Affordance::sample(const LadderEstimate& estimate, int rung, const RungSurface& surface,
                        std::span<const RailLine> rails) {
  const double length = std::min(length_m(estimate.rungs[rung]), params_.max_length_m);
  const int num_steps = std::max(1, static_cast<int>(std::floor(length / params_.step_m)));
  step_m_ = length / num_steps;
  find_blocked(estimate, rung, surface.margin_m, rails);
  samples_.clear();
  for (int q = 0; q < num_steps; ++q) {
    samples_.push_back(reason_at(estimate, rung, surface, (q + 0.5) * step_m_));
  }
}

void Affordance::find_blocked(const LadderEstimate& estimate, int rung, double margin_m,
                              std::span<const RailLine> rails) {
  blocked_.clear();
  const Rung& self = estimate.rungs[rung];
  const double length = length_m(self);
  const Axis axis{self.end0_m, unit(self.end1_m - self.end0_m, Eigen::Vector3d::UnitX())};
  const double claw_m = params_.claw_width_m + std::max(params_.claw_margin_m, margin_m);
  // A sound rung ends at the inner faces of its rails.
  blocked_.push_back({0.0, claw_m, Reason::kRailTooNear});
  blocked_.push_back({length - claw_m, length, Reason::kRailTooNear});
  const auto block = [&](const Eigen::Vector3d& end0_m, const Eigen::Vector3d& end1_m,
                         double reach_m, Reason reason) {
    const Axis other{end0_m, unit(end1_m - end0_m, Eigen::Vector3d::UnitZ())};
    const Approach at = nearest(axis, other);
    const double u = std::clamp(at.u, 0.0, other.along(end1_m));
    const double t = axis.along(other.at(u));
    if (axis.distance(other.at(u)) > params_.outlier_reach_m) return;
    blocked_.push_back({t - reach_m, t + reach_m, reason});
  };
  for (const RailLine& rail : rails) {
    block(rail.end0_m, rail.end1_m, claw_m + rail.half_width_m, Reason::kRailTooNear);
  }
  for (int i = 0; i < static_cast<int>(estimate.rungs.size()); ++i) {
    if (i == rung) continue;
    const Rung& other = estimate.rungs[i];
    // Beside each other over a length (a handle on the rung) or crossing at a point.
    const double from_m = axis.along(other.end0_m);
    const double to_m = axis.along(other.end1_m);
    const bool beside = axis.distance(other.end0_m) < params_.outlier_reach_m &&
                        axis.distance(other.end1_m) < params_.outlier_reach_m;
    if (beside) {
      blocked_.push_back({std::min(from_m, to_m) - params_.clearance_m,
                          std::max(from_m, to_m) + params_.clearance_m, Reason::kOtherRungTooNear});
    } else {
      block(other.end0_m, other.end1_m, params_.clearance_m + other.radius_m,
            Reason::kOtherRungTooNear);
    }
  }
}

Reason Affordance::reason_at(const LadderEstimate& estimate, int rung, const RungSurface& surface,
                             double along_m) const {
  const double half_step_m = 0.5 * step_m_;
  for (const Block& block : blocked_) {
    if (along_m + half_step_m > block.from_m && along_m - half_step_m < block.to_m) {
      return block.reason;
    }
  }
  const double length = length_m(estimate.rungs[rung]);
  const auto stretch = [&](double t) {
    const double place = std::floor(std::max(0.0, t) / length * kNumStretches);
    return std::min(static_cast<int>(place), kNumStretches - 1);
  };
  for (int i = stretch(along_m - half_step_m); i <= stretch(along_m + half_step_m); ++i) {
    if (surface.attached.test(i)) return Reason::kOutlierTooNear;
    if (!surface.seen.test(i)) return Reason::kNotSeen;
  }
  return Reason::kNone;
}

void Affordance::append_runs(int rung, LadderEstimate& estimate) {
  const int num_samples = static_cast<int>(samples_.size());
  for (int begin = 0; begin < num_samples;) {
    int end = begin;
    while (end < num_samples && samples_[end] == samples_[begin]) ++end;
    Reason reason = samples_[begin];
    const bool too_short = (end - begin) * step_m_ < params_.gripper_width_m;
    if (reason == Reason::kNone && too_short) reason = Reason::kTooShort;
    estimate.intervals.push_back({rung, begin * step_m_, end * step_m_, reason});
    begin = end;
  }
}

void Affordance::offer(int rung, const Eigen::Vector3d& body_m, LadderEstimate& estimate) {
  const std::size_t first = estimate.intervals.size();
  append_runs(rung, estimate);
  const Interval* best = nullptr;
  for (std::size_t i = first; i < estimate.intervals.size(); ++i) {
    const Interval& interval = estimate.intervals[i];
    if (interval.reason != Reason::kNone) continue;
    if (best == nullptr || interval.to_m - interval.from_m > best->to_m - best->from_m) {
      best = &interval;
    }
  }
  if (best == nullptr) return;
  const Rung& self = estimate.rungs[rung];
  const Axis axis{self.end0_m, unit(self.end1_m - self.end0_m, Eigen::Vector3d::UnitX())};
  Grasp grasp;
  grasp.rung = rung;
  grasp.position_m = axis.at(0.5 * (best->from_m + best->to_m));
  grasp.approach = level_direction(body_m, grasp.position_m);
  grasp.confidence = self.confidence;
  estimate.grasps.push_back(grasp);
}

}  // namespace ladder
