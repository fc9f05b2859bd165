// SPDX-License-Identifier: BSD-3-Clause
// How far the axis of a round bar lies behind its visible front, on average.
#pragma once

#include <array>
#include <cmath>

namespace ladder {

/// Mean of sqrt(r^2 - y^2) over |y| <= half_height, 0 < half_height <= radius, by Gauss-Legendre
/// quadrature (square roots only; within 0.4 % of r up to the full height).
inline double mean_chord_depth_m(double radius_m, double half_height_m) {
  constexpr std::array<double, 4> kNode = {0.06943184420297371, 0.33000947820757187,
                                           0.66999052179242813, 0.93056815579702629};
  constexpr std::array<double, 4> kWeight = {0.17392742256872693, 0.32607257743127307,
                                             0.32607257743127307, 0.17392742256872693};
  double depth_m = 0.0;
  for (std::size_t i = 0; i < kNode.size(); ++i) {
    const double y_m = kNode[i] * half_height_m;
    depth_m += kWeight[i] * std::sqrt(radius_m * radius_m - y_m * y_m);
  }
  return depth_m;
}

}  // namespace ladder
