// SPDX-License-Identifier: BSD-3-Clause
#include "ladder/bar.h"

#include <algorithm>

#include "ladder/range_noise.h"

namespace ladder {

bool fit(const BarNodes& nodes, std::span<const int> members, double max_noise_share, Bar& bar) {
  if (members.size() < 3) return false;
  bar.sum = MomentSum{};
  Eigen::Vector3d eye_sum_m = Eigen::Vector3d::Zero();
  for (const int k : members) {
    bar.sum.add(nodes.sum(k));
    eye_sum_m += nodes[k].eye_sum_m;
  }
  bar.eye_m = eye_sum_m / bar.sum.weight;
  bar.spread = principal_axis(sharp_covariance(bar.sum, bar.eye_m, max_noise_share));
  const bool turned = bar.spread.direction.dot(bar.axis.direction) < 0.0;
  bar.axis = {bar.sum.mean(),
              turned ? Eigen::Vector3d(-bar.spread.direction) : bar.spread.direction};
  bar.from_m = bar.to_m = bar.axis.along(nodes.position_m(members[0]));
  for (const int k : members) {
    const double t = bar.axis.along(nodes.position_m(k));
    bar.from_m = std::min(bar.from_m, t);
    bar.to_m = std::max(bar.to_m, t);
  }
  return true;
}

}  // namespace ladder
