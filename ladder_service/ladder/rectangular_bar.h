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

/// How much of what is seen of a bar, across the view, is its front; the rest is the side that
/// begins at its nearer edge. `bend`: covariance of depth and place across / variance of the place,
/// counted from the front towards that edge; tangent > 0: of the angle between view and the front's
/// normal. Noise is along the view and leaves both alone.
inline double front_share(double bend, double tangent) {
  constexpr int kNumHalvings = 20;
  constexpr double kLeastTangent = 0.02;  // straight on: all of it
  if (!(tangent > kLeastTangent)) return 1.0;
  const double per_tangent = 1.0 / tangent;
  const double wanted = (per_tangent - bend) / (1.5 * (tangent + per_tangent));
  double low = -1.0, high = 1.0;  // of the edge, in halves of what is seen
  for (int i = 0; i < kNumHalvings; ++i) {
    const double u = 0.5 * (low + high);
    (1.0 / 3.0 + 0.5 * u - u * u * u / 6.0 < wanted ? low : high) = u;
  }
  return 0.5 * (1.0 + 0.5 * (low + high));
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
