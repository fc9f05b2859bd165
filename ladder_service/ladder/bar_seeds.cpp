// SPDX-License-Identifier: BSD-3-Clause
#include "ladder/bar_seeds.h"

#include <algorithm>
#include <cmath>

#include "ladder/principal_axis.h"
#include "ladder/range_noise.h"

namespace ladder {
namespace {

constexpr int kMinNeighbors = 3;  // itself included
// Variances of nodes on one exact line are zero across it: they count as this at least.
constexpr double kMinVariance_m2 = 1e-9;

int sum_neighborhood(const BarNodes& nodes, int k, double radius_m,
                     const std::vector<std::uint8_t>& taken, MomentSum& sum) {
  const Eigen::Vector3d& center = nodes.position_m(k);
  const BarNodes::Range range = nodes.between(center.z() - radius_m, center.z() + radius_m);
  int count = 0;
  for (int j = range.begin; j < range.end; ++j) {
    if ((nodes.position_m(j) - center).squaredNorm() >= radius_m * radius_m || taken[j]) continue;
    sum.add(nodes.sum(j));
    ++count;
  }
  return count;
}

}  // namespace

void find_seeds(const BarNodes& nodes, const BarParams& params, const SeedSearch& search,
                const std::vector<std::uint8_t>& taken, std::vector<Seed>& seeds) {
  seeds.clear();
  for (int k = 0; k < nodes.size(); ++k) {
    if (taken[k]) continue;
    MomentSum sum;
    if (sum_neighborhood(nodes, k, search.neighborhood_m, taken, sum) < kMinNeighbors) continue;
    const Eigen::Vector3d eye_m = nodes[k].eye_sum_m / nodes.weight(k);
    const PrincipalAxis axis = principal_axis(sharp_covariance(sum, eye_m, params.max_noise_share));
    if (!axis.is_linear(params.seed_linearity)) continue;
    const double dz = std::abs(axis.direction.z());
    const bool upright = dz > params.upright_min_dz;
    if (!upright && dz >= params.level_max_dz) continue;
    if (upright && !search.upright_too) continue;
    const double linearity = axis.first_m2 / std::max(kMinVariance_m2, axis.second_m2);
    seeds.push_back({{sum.mean(), axis.direction}, linearity, k, upright});
  }
  std::sort(seeds.begin(), seeds.end(), [](const Seed& a, const Seed& b) {
    return a.linearity > b.linearity || (a.linearity == b.linearity && a.node < b.node);
  });
}

}  // namespace ladder
