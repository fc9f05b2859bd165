// SPDX-License-Identifier: BSD-3-Clause
#include "ladder/tread_test.h"

#include <algorithm>
#include <cmath>

namespace ladder {
namespace {

constexpr double kKeepDepth = 0.9;  // of older frames
// Tangent of the angle between view and level: below the least a board hides behind its edge, above
// the other more of it says no more.
constexpr double kMinTangent = 0.12;
constexpr double kEnoughTangent = 0.35;

/// Share of a node's points between the two places; they are spread evenly about its mean.
double share_between(double from_m, double to_m, double mean_m, double variance_m2) {
  constexpr double kLeastReach_m = 1e-4;
  const double reach_m = std::max(kLeastReach_m, std::sqrt(3.0 * std::max(0.0, variance_m2)));
  const double overlap_m = std::min(to_m, mean_m + reach_m) - std::max(from_m, mean_m - reach_m);
  return std::max(0.0, overlap_m) / (2.0 * reach_m);
}

/// Half of the weight lies at or below it.
double weighted_median(std::vector<std::pair<double, double>>& values) {
  std::sort(values.begin(), values.end());
  double half = 0.0;
  for (const auto& [value, weight] : values) half += 0.5 * weight;
  std::size_t median = 0;
  for (double below = values[0].second; below < half && median + 1 < values.size();) {
    below += values[++median].second;
  }
  return values[median].first;
}

}  // namespace

double surplus_behind(const BarNodes& nodes, const BarFront& front,
                      const LadderTestParams& params) {
  const Eigen::Vector3d& d = front.axis.direction;
  const double reach_m = std::max(std::abs(front.from_m), std::abs(front.to_m));
  const double rise_m = std::abs(d.z()) * reach_m + params.deep_half_height_m;
  const double z_m = front.axis.origin_m.z();
  const BarNodes::Range range = nodes.between(z_m - rise_m, z_m + rise_m);
  double surplus = 0.0;
  for (int k = range.begin; k < range.end; ++k) {
    const Eigen::Vector3d w = nodes.position_m(k) - front.axis.origin_m;
    const double t = w.dot(d);
    if (t < front.from_m || t > front.to_m) continue;
    if (std::abs(w.z() - t * d.z()) > params.deep_half_height_m) continue;
    const double q = w.dot(front.behind);
    const Eigen::Matrix3d covariance = nodes.sum(k).covariance();
    const double variance_m2 = front.behind.dot(covariance * front.behind);
    const double share = share_between(params.tread_from_m, params.tread_to_m, q, variance_m2) -
                         share_between(-params.tread_to_m, -params.tread_from_m, q, variance_m2);
    surplus += share * nodes.weight(k);
  }
  return surplus;
}

TreadTest::TreadTest(const LadderParams& params) : min_depth_m_(params.test.tread_min_depth_m) {
  depths_.reserve(params.max_bars);
}

// A board that is seen at the angle e off level, as high as the bar, shows its depth times tan e
// for each of its heights.
void TreadTest::learn(const std::vector<MeasuredBar>& bars) {
  depths_.clear();
  double weight = 0.0;
  for (const MeasuredBar& bar : bars) {
    if (!bar.on_ladder) continue;
    const double sine = std::min(1.0, std::abs(bar.depth.z()));
    const double cosine = std::sqrt(1.0 - sine * sine);
    if (!(sine > kMinTangent * cosine)) continue;
    const double height_m = 2.0 * bar.radius_m;
    const double depth_m = bar.surplus * height_m * cosine / sine;
    const double bar_weight = bar.weight * std::min(sine, kEnoughTangent * cosine) / cosine;
    if (!std::isfinite(depth_m) || !(bar_weight > 0.0)) continue;
    // What was found at the wide height may be a board's middle, with as much before it as behind.
    if (bar.is_wide && depth_m < min_depth_m_) continue;
    depths_.emplace_back(depth_m, bar_weight);
    weight += bar_weight;
  }
  if (depths_.empty()) return;
  depth_sum_ = kKeepDepth * depth_sum_ + weight * weighted_median(depths_);
  weight_ = kKeepDepth * weight_ + weight;
}

bool TreadTest::has_treads() const {
  return depth_sum_ > min_depth_m_ * weight_;
}

}  // namespace ladder
