// SPDX-License-Identifier: BSD-3-Clause
// Where the cloud was seen from.
#pragma once

#include <optional>

#include <Eigen/Core>

#include "ddgng/cloud.h"

namespace ddgng {

/// Mean position of the valid heads, odom frame.
inline std::optional<Eigen::Vector3f> mean_head_position(const CloudView& cloud) {
  Eigen::Vector3f sum_m = Eigen::Vector3f::Zero();
  int num_valid = 0;
  for (int head = 0; head < kNumHeads; ++head) {
    if (!cloud.head_valid[head]) continue;
    sum_m += cloud.head_position_m[head];
    ++num_valid;
  }
  if (num_valid == 0) return std::nullopt;
  return sum_m / static_cast<float>(num_valid);
}

/// The valid head nearest to p; ties to the lowest number.
inline std::optional<Eigen::Vector3f> nearest_head_position(const CloudView& cloud,
                                                            const Eigen::Vector3f& p) {
  std::optional<Eigen::Vector3f> nearest;
  double smallest_m2 = 0.0;
  for (int head = 0; head < kNumHeads; ++head) {
    if (!cloud.head_valid[head]) continue;
    const Eigen::Vector3f& position_m = cloud.head_position_m[head];
    const double distance_m2 = (position_m - p).cast<double>().squaredNorm();
    if (nearest && distance_m2 >= smallest_m2) continue;
    nearest = position_m;
    smallest_m2 = distance_m2;
  }
  return nearest;
}

}  // namespace ddgng
