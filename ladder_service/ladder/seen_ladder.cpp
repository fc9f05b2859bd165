// SPDX-License-Identifier: BSD-3-Clause
#include "ladder/seen_ladder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace ladder {
namespace {

using Eigen::Vector3d;

using HeadSums = std::array<MomentSum, kNumHeads>;

bool is_usable(const NodeCloud& cloud, const HeadMoment& m, const AlignParams& params) {
  return cloud.head_valid[m.head] && m.weight >= params.min_weight && m.mean_m.allFinite();
}

/// Calls `take` with each usable moment of the bar's nodes between the two places along it.
template <class Take>
void for_each_moment(const SeenFrame& frame, const AlignParams& params, const Bar& bar,
                     const SeenRung& stretch, const Take& take) {
  for (const int k : frame.bars.members_of(bar)) {
    const double t = bar.axis.along(frame.nodes.position_m(k));
    if (t < stretch.from_m || t > stretch.to_m) continue;
    const BarNode& node = frame.nodes[k];
    for (int i = 0; i < node.num_moments; ++i) {
      const HeadMoment& m = frame.cloud.moments[node.first_moment + i];
      if (is_usable(frame.cloud, m, params)) take(m);
    }
  }
}

/// What one head's points on one rung are worth together, per point: noise averages out over them,
/// what the view does to all of them does not. Nothing where the image ends within the rung: the
/// middle of what is left is not the rung's.
std::array<double, kNumHeads> weights(const HeadSums& heads, const Vector3d& up,
                                      const Vector3d& normal, const SeenRung& rung,
                                      const AlignParams& params) {
  constexpr double kShape = 0.1;  // so unsure is how far the axis lies behind the front
  // Where a rung is seen is known by the pixel, how far it is by the range.
  const double across = normal.dot(up);
  const double sigma2_m2 = params.sigma_bar_m * params.sigma_bar_m +
                           (1.0 - across * across) * params.sigma_range_m * params.sigma_range_m +
                           kShape * kShape * rung.front_m * rung.front_m;
  std::array<double, kNumHeads> weight{};
  for (int head = 0; head < kNumHeads; ++head) {
    const double points = heads[head].weight;
    if (points < params.min_bar_weight) continue;
    const Eigen::Matrix3d covariance_m2 = heads[head].covariance();
    const double half_height2_m2 = 3.0 * up.dot(covariance_m2 * up);
    if (half_height2_m2 < rung.least_half_height_m * rung.least_half_height_m) continue;
    const double noise_m2 = std::max(0.0, normal.dot(covariance_m2 * normal)) / points;
    weight[head] = 1.0 / (points * (sigma2_m2 + noise_m2));
  }
  return weight;
}

HeadSums sums(const SeenFrame& frame, const AlignParams& params, const Bar& bar,
              const SeenRung& stretch) {
  HeadSums heads;
  for_each_moment(frame, params, bar, stretch,
                  [&](const HeadMoment& m) { heads[m.head].add(to_sum(m)); });
  return heads;
}

/// From a head's mean on a round bar to its axis.
Vector3d behind_front_m(const Vector3d& arm_m, const Vector3d& direction, double front_m) {
  const Vector3d across_m = arm_m - arm_m.dot(direction) * direction;
  return front_m * unit(across_m, Vector3d::Zero());
}

enum class Across { kUp, kDepth };

void add_rungs(const SeenFrame& frame, const SeenLadder& ladder, const AlignParams& params,
               double share, Across across, AlignmentEquations& equations) {
  const Vector3d depth = ladder.along.cross(ladder.up);
  const Vector3d& normal = across == Across::kUp ? ladder.up : depth;
  const Vector3d middle_m = frame.bars.rails[ladder.left].axis.origin_m;
  equations.begin_surface(normal);
  for (const SeenRung& rung : ladder.rungs) {
    const Bar& bar = frame.bars.rungs[rung.bar];
    const std::array<double, kNumHeads> weight =
        weights(sums(frame, params, bar, rung), ladder.up, normal, rung, params);
    for_each_moment(frame, params, bar, rung, [&](const HeadMoment& m) {
      if (!(weight[m.head] > 0.0)) return;
      AlignmentEquations::Sample row;
      row.head = m.head;
      const Vector3d point_m = m.mean_m.cast<double>();
      row.arm_m = point_m - frame.cloud.head_position_m[m.head].cast<double>();
      const Vector3d place_m =
          point_m + behind_front_m(row.arm_m, bar.axis.direction, rung.front_m) - middle_m;
      row.off_m = normal.dot(place_m);
      const double second =
          across == Across::kUp ? static_cast<double>(rung.level) : ladder.up.dot(place_m);
      row.shape = {1.0, second, ladder.along.dot(place_m)};
      row.weight = share * static_cast<double>(m.weight) * weight[m.head];
      equations.add(row);
    });
  }
  equations.end_surface();
}

}  // namespace

void number_levels(std::span<const double> heights_m, const LadderTestParams& params,
                   std::span<int> levels) {
  double step_m = std::numeric_limits<double>::max();
  for (std::size_t i = 1; i < heights_m.size(); ++i) {
    const double distance_m = heights_m[i] - heights_m[i - 1];
    if (distance_m > params.frame_min_spacing_m) step_m = std::min(step_m, distance_m);
  }
  std::size_t last = 0;
  for (std::size_t i = 0; i < heights_m.size(); ++i) {
    const double steps = (heights_m[i] - heights_m[last]) / step_m;
    const double whole = std::floor(steps + 0.5);
    levels[i] = i == 0 ? 0 : -1;
    const bool is_whole = whole >= 1.0 && std::abs(steps - whole) <= params.spacing_tolerance;
    if (i == 0 || !is_whole) continue;
    levels[i] = levels[last] + static_cast<int>(whole);
    last = i;
  }
}

void add_ladder(const SeenFrame& frame, const SeenLadder& ladder, const AlignParams& params,
                double share, AlignmentEquations& equations) {
  if (!ladder.found() || !(share > 0.0)) return;
  add_rungs(frame, ladder, params, share, Across::kUp, equations);
  add_rungs(frame, ladder, params, share, Across::kDepth, equations);
}

}  // namespace ladder
