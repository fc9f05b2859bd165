// SPDX-License-Identifier: BSD-3-Clause
#include "ladder/backdrop.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ladder {
namespace {

/// A backdrop is farther behind the bar than its own points scatter.
constexpr double kLeastGap_m = 0.05;
/// Nodes on planes lie so far apart that each stands for so much around it; others are dense.
constexpr double kPlaneReach_m = 0.25;
constexpr double kNodeReach_m = 0.05;

}  // namespace

double backed_share(const NodeCloud& cloud, const SeenStretch& bar) {
  constexpr int kNumRays = 5;
  std::array<Axis, kNumRays> rays;
  std::array<double, kNumRays> least_m{};
  std::array<bool, kNumRays> is_backed{};
  for (int i = 0; i < kNumRays; ++i) {
    const double t = bar.from_m + (i + 0.5) / kNumRays * (bar.to_m - bar.from_m);
    const Eigen::Vector3d ray = bar.axis.at(t) - bar.eye_m;
    rays[i] = {bar.eye_m, unit(ray, Eigen::Vector3d::UnitX())};
    least_m[i] = std::sqrt(ray.squaredNorm()) + kLeastGap_m;
  }
  for (int node = 0; node < cloud.num_nodes(); ++node) {
    const Eigen::Vector3d place_m = cloud.node_m(node);
    const double reach_m = cloud.plane[node] >= 0 ? kPlaneReach_m : kNodeReach_m;
    for (int i = 0; i < kNumRays; ++i) {
      if (is_backed[i] || !(rays[i].along(place_m) > least_m[i])) continue;
      is_backed[i] = rays[i].across(place_m).squaredNorm() < reach_m * reach_m;
    }
  }
  return static_cast<double>(std::count(is_backed.begin(), is_backed.end(), true)) / kNumRays;
}

}  // namespace ladder
