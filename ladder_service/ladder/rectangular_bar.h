// SPDX-License-Identifier: BSD-3-Clause
// What is seen of a bar of rectangular section: its front and, from the side, one more face. Points
// lie evenly over what is seen, at a right angle to the view.
#pragma once

#include <algorithm>
#include <cmath>

namespace ladder {

/// Half of what is seen of a square bar, in halves of its side. The sine: of the angle between the
/// view and the front's normal.
inline double square_height(double sine) {
  const double s = std::min(1.0, std::abs(sine));
  return std::sqrt(1.0 - s * s) + s;
}

/// How far the middle of the front lies beside the mean of all points, along the front, in the
/// sense of the view; from the halves of the front and of what is seen.
inline double beside_seen_m(double half_front_m, double half_seen_m, double sine) {
  constexpr double kMaxHalfDepth_m = 0.04;  // of the bar: more is seen for other reasons
  const double s = std::clamp(sine, -1.0, 1.0);
  const double front_m = half_front_m * std::sqrt(1.0 - s * s);
  const double side_m = std::clamp(half_seen_m - front_m, 0.0, kMaxHalfDepth_m * std::abs(s));
  if (!(side_m > 0.0)) return 0.0;
  return std::copysign(half_front_m * side_m / (front_m + side_m), s);
}

}  // namespace ladder
