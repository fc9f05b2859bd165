// SPDX-License-Identifier: BSD-3-Clause
#include "ladder/flank_test.h"

#include <algorithm>
#include <cmath>

namespace ladder {
namespace {

constexpr double kEnd_m = 0.03;          // rails at the ends do not count
constexpr double kMinStretch_m = 0.04;   // unless nothing would remain
constexpr double kMinSine = 0.2;         // between view and axis
constexpr double kOwnDepthFactor = 1.6;  // own points reach so many half heights in depth

}  // namespace

Flanks measure_flanks(const BarNodes& nodes, const Bar& bar, const BarParams& params) {
  Flanks flanks;
  const Eigen::Vector3d& d = bar.axis.direction;
  const Eigen::Vector3d ray = unit(bar.axis.origin_m - bar.eye_m, Eigen::Vector3d::UnitX());
  const Eigen::Vector3d across = ray - ray.dot(d) * d;
  const double sine = std::sqrt(across.squaredNorm());
  if (sine < kMinSine) return flanks;
  const Eigen::Vector3d depth = across / sine;
  const Eigen::Vector3d height = d.cross(depth);

  const double half_m = bar.wide ? params.wide_half_height_m : params.narrow_half_height_m;
  double from_m = bar.from_m + kEnd_m;
  double to_m = bar.to_m - kEnd_m;
  if (to_m - from_m < kMinStretch_m) {
    from_m = bar.from_m;
    to_m = bar.to_m;
  }
  const double outer_m = std::max(half_m + params.flank_width_m, 2.0 * half_m);
  const double depth_m = std::max(params.flank_depth_m, kOwnDepthFactor * half_m);
  const double rise_m = std::abs(d.z()) * std::max(-from_m, to_m) + outer_m + depth_m;
  const double z_m = bar.axis.origin_m.z();
  const BarNodes::Range range = nodes.between(z_m - rise_m, z_m + rise_m);
  for (int k = range.begin; k < range.end; ++k) {
    const Eigen::Vector3d w = nodes.position_m(k) - bar.axis.origin_m;
    const double t = w.dot(d);
    if (t < from_m || t > to_m) continue;
    const double q = std::abs(w.dot(depth));
    const double e = w.dot(height);
    const double weight = nodes.weight(k);
    if (q < kOwnDepthFactor * half_m && std::abs(e) < half_m) flanks.own += weight;
    if (q < kOwnDepthFactor * half_m && std::abs(e) < 2.0 * half_m) flanks.twice += weight;
    if (std::abs(e) < half_m || std::abs(e) >= half_m + params.flank_width_m) continue;
    if (q < params.flank_depth_m) (e > 0.0 ? flanks.above : flanks.below) += weight;
  }
  return flanks;
}

}  // namespace ladder
