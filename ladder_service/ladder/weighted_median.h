// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace ladder {

/// The first of the values, ascending, at which half of all weight is reached; of (value, weight)
/// pairs, which are put in order. 0 without any.
inline double weighted_median(std::vector<std::pair<double, double>>& values) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  double weight = 0.0;
  for (const auto& value : values) weight += value.second;
  std::size_t median = 0;
  for (double below = values[0].second; below < 0.5 * weight && median + 1 < values.size();) {
    below += values[++median].second;
  }
  return values[median].first;
}

}  // namespace ladder
