// SPDX-License-Identifier: BSD-3-Clause
// The noise of a range camera lies along the view: a bar at the far end of its range is as sharp as
// ever across it and a sheet along it. What of a covariance may be such noise, and what is left.
#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "ladder/moment_sum.h"

namespace ladder {

/// `covariance_m2` of points seen along `view_m` (from the eye, as long as the range), less the
/// noise along it, at most `max_share` of the range: what varies along the view but not with the
/// place in the picture, 1 / (v' C^-1 v). What is left stays positive semi-definite up to rounding;
/// a covariance without volume is left as it is.
inline Eigen::Matrix3d without_range_noise(const Eigen::Matrix3d& covariance_m2,
                                           const Eigen::Vector3d& view_m, double max_share) {
  const double scale_m2 = covariance_m2.trace();
  const double range2_m2 = view_m.squaredNorm();
  if (!(scale_m2 > 0.0) || !(range2_m2 > 0.0)) return covariance_m2;
  const Eigen::Matrix3d scaled = covariance_m2 / scale_m2;
  const Eigen::Vector3d view = view_m / std::sqrt(range2_m2);
  const Eigen::Vector3d x = scaled.col(0);
  const Eigen::Vector3d y = scaled.col(1);
  const Eigen::Vector3d z = scaled.col(2);
  // C^-1 = adjugate / determinant.
  const Eigen::Vector3d adjugate_view =
      view.x() * y.cross(z) + view.y() * z.cross(x) + view.z() * x.cross(y);
  const double in_picture = view.dot(adjugate_view);
  const double determinant = x.dot(y.cross(z));
  constexpr double kLeast = 1e-12;
  if (!(in_picture > kLeast) || !(determinant > 0.0)) return covariance_m2;
  const double noise_m2 =
      std::min(max_share * max_share * range2_m2, scale_m2 * determinant / in_picture);
  return covariance_m2 - noise_m2 * view * view.transpose();
}

/// Of points that `eye_m` sees.
inline Eigen::Matrix3d sharp_covariance(const MomentSum& points, const Eigen::Vector3d& eye_m,
                                        double max_share) {
  return without_range_noise(points.covariance(), points.mean() - eye_m, max_share);
}

}  // namespace ladder
