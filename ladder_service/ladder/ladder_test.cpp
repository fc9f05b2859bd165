// SPDX-License-Identifier: BSD-3-Clause
#include "ladder/ladder_test.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ladder {

LadderTest::LadderTest(const LadderParams& params) : params_(params.test) {
  trial_.joints.reserve(params.max_bars);
  best_.joints.reserve(params.max_bars);
  heights_m_.reserve(params.max_bars);
}

const LadderHypothesis& LadderTest::find(const BarNodes& nodes, const BarSet& bars,
                                         const Eigen::Vector3d& body_m) {
  best_.left = best_.right = -1;
  best_.score = 0.0;
  best_.joints.clear();
  const int num_rails = static_cast<int>(bars.rails.size());
  for (int i = 0; i < num_rails; ++i) {
    for (int j = i + 1; j < num_rails; ++j) {
      const Eigen::Vector3d& a = bars.rails[i].axis.origin_m;
      const Eigen::Vector3d& b = bars.rails[j].axis.origin_m;
      const Eigen::Vector3d ahead = level_direction(body_m, 0.5 * (a + b));
      const bool i_left = (b - a).dot(ahead.cross(Eigen::Vector3d::UnitZ())) >= 0.0;
      trial_.left = i_left ? i : j;
      trial_.right = i_left ? j : i;
      if (!are_rails(bars.rails[trial_.left], bars.rails[trial_.right])) continue;
      collect_joints(bars);
      if (!has_rungs()) continue;
      if (trial_.score > best_.score) std::swap(trial_, best_);
    }
  }
  if (best_.found() && hole_ratio(nodes, bars) > params_.hole_max) {
    best_.left = best_.right = -1;
    best_.joints.clear();
  }
  return best_;
}

bool LadderTest::are_rails(const Bar& left, const Bar& right) const {
  if (left.axis.direction.dot(right.axis.direction) < params_.rail_min_cos) return false;
  const double width_m = left.axis.distance(right.axis.origin_m);
  return width_m >= params_.min_width_m && width_m <= params_.max_width_m;
}

void LadderTest::collect_joints(const BarSet& bars) {
  trial_.joints.clear();
  trial_.score = 0.0;
  for (int i = 0; i < static_cast<int>(bars.rungs.size()); ++i) {
    Joint found;
    found.bar = i;
    if (!joint(bars, bars.rungs[i], found)) continue;
    trial_.joints.push_back(found);
    trial_.score += found.is_whole() ? 1.0 : params_.half_score;
  }
}

bool LadderTest::joint(const BarSet& bars, const Bar& bar, Joint& out) const {
  if (bar.wide && !params_.thick_rungs) return false;
  const Bar& left = bars.rails[trial_.left];
  const Bar& right = bars.rails[trial_.right];
  const Eigen::Vector3d to_right =
      unit(left.axis.across(right.axis.origin_m), Eigen::Vector3d::UnitX());
  if (bar.axis.direction.dot(to_right) < params_.rung_min_cos) return false;
  const Approach at_left = nearest(bar.axis, left.axis);
  const Approach at_right = nearest(bar.axis, right.axis);
  const double nearer_m = std::min(at_left.distance_m, at_right.distance_m);
  const double farther_m = std::max(at_left.distance_m, at_right.distance_m);
  if (nearer_m > params_.attach_m) return false;
  if (farther_m > params_.attach_m * params_.attach_far_factor) return false;
  // A bar that goes on beyond a rail belongs to something else.
  if (bar.from_m < at_left.t - params_.rung_overrun_m) return false;
  if (bar.to_m > at_right.t + params_.rung_overrun_m) return false;
  // A rail goes on where nobody looks, beside a rung that reaches only the other one; what comes
  // near to where it would be does not reach it.
  const auto is_seen = [&](const Bar& rail, double u) {
    return u >= rail.from_m - params_.rail_overrun_m && u <= rail.to_m + params_.rail_overrun_m;
  };
  const auto may_go_on = [&](const Bar& rail, double u) {
    return u >= rail.from_m - params_.rail_unseen_m && u <= rail.to_m + params_.rail_unseen_m;
  };
  if (!may_go_on(left, at_left.u) || !may_go_on(right, at_right.u)) return false;
  out.reaches_left = is_seen(left, at_left.u) && bar.from_m < at_left.t + params_.reach_rail_m;
  out.reaches_right = is_seen(right, at_right.u) && bar.to_m > at_right.t - params_.reach_rail_m;
  out.height_m = at_left.u;
  return out.reaches_left || out.reaches_right;
}

// Whole rungs at whole multiples of a spacing; where few are whole (a head is dead, the ladder is
// seen from the side), one of them and halves beside it.
bool LadderTest::has_rungs() {
  const auto num_joints = static_cast<int>(trial_.joints.size());
  const auto num_whole = static_cast<int>(std::count_if(
      trial_.joints.begin(), trial_.joints.end(), [](const Joint& x) { return x.is_whole(); }));
  if (num_whole >= params_.min_whole_rungs) {
    return num_regular_steps(true) >= params_.min_whole_rungs - 1;
  }
  return num_whole >= 1 && num_joints >= params_.min_partial_rungs &&
         num_regular_steps(false) >= params_.min_partial_rungs - 1;
}

int LadderTest::num_regular_steps(bool whole_only) {
  heights_m_.clear();
  for (const Joint& x : trial_.joints) {
    if (x.is_whole() || !whole_only) heights_m_.push_back(x.height_m);
  }
  std::sort(heights_m_.begin(), heights_m_.end());
  double spacing_m = std::numeric_limits<double>::max();
  for (std::size_t i = 1; i < heights_m_.size(); ++i) {
    const double step_m = heights_m_[i] - heights_m_[i - 1];
    if (step_m > params_.min_joint_distance_m) spacing_m = std::min(spacing_m, step_m);
  }
  // Where the one between two of them is missing, they are two spacings apart.
  if (spacing_m >= params_.frame_max_spacing_m) spacing_m *= 0.5;
  if (spacing_m <= params_.frame_min_spacing_m || spacing_m >= params_.frame_max_spacing_m)
    return 0;
  int count = 0;
  for (std::size_t i = 1; i < heights_m_.size(); ++i) {
    const double steps = (heights_m_[i] - heights_m_[i - 1]) / spacing_m;
    const double whole = std::floor(steps + 0.5);
    if (whole >= 1.0 && std::abs(steps - whole) < params_.spacing_tolerance) ++count;
  }
  return count;
}

double LadderTest::hole_ratio(const BarNodes& nodes, const BarSet& bars) const {
  const Bar& left_rail = bars.rails[best_.left];
  const Bar& right_rail = bars.rails[best_.right];
  const Axis& left = left_rail.axis;
  const Eigen::Vector3d across = left.across(right_rail.axis.origin_m);
  const double width_m = std::sqrt(across.squaredNorm());
  const Eigen::Vector3d to_right = across / width_m;
  const Eigen::Vector3d normal = left.direction.cross(to_right);
  double low_m = std::numeric_limits<double>::max();
  double high_m = -low_m;
  for (const Joint& x : best_.joints) {
    if (!x.is_whole()) continue;
    const double t = left.along(bars.rungs[x.bar].axis.origin_m);
    low_m = std::min(low_m, t - params_.hole_margin_m);
    high_m = std::max(high_m, t + params_.hole_margin_m);
  }
  constexpr double kBeyondEnd_m = 0.03;
  double on_rungs = 0.0;
  double in_panel = 0.0;
  for (int k = 0; k < nodes.size(); ++k) {
    const Eigen::Vector3d w = nodes.position_m(k) - left.origin_m;
    const double t = w.dot(left.direction);
    const double u = w.dot(to_right);
    if (t < low_m || t > high_m) continue;
    if (u < params_.hole_rail_m || u > width_m - params_.hole_rail_m) continue;
    if (std::abs(w.dot(normal)) > params_.hole_depth_m) continue;
    // Seen from the side, noise carries a rail's points into the panel.
    const Eigen::Vector3d& p = nodes.position_m(k);
    const double rail_m = std::min(left_rail.distance_m(p), right_rail.distance_m(p));
    if (rail_m < params_.hole_rail_m) continue;
    double rung_m = std::numeric_limits<double>::max();
    for (const Joint& x : best_.joints) {
      const Bar& bar = bars.rungs[x.bar];
      const double s = bar.axis.along(p);
      if (s < bar.from_m - kBeyondEnd_m || s > bar.to_m + kBeyondEnd_m) continue;
      rung_m = std::min(rung_m, bar.distance_m(p));
    }
    if (rung_m < params_.on_rung_m) on_rungs += nodes.weight(k);
    if (rung_m > params_.hole_rung_m) in_panel += nodes.weight(k);
  }
  // Nothing on the rungs counts as full: no evidence, no ladder.
  return on_rungs > 0.0 ? in_panel / on_rungs : std::numeric_limits<double>::max();
}

}  // namespace ladder
