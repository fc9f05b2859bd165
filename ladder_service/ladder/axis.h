// SPDX-License-Identifier: BSD-3-Clause
// A straight line in space and where two of them come nearest.
#pragma once

#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace ladder {

/// Points origin_m + t direction; direction is a unit vector.
struct Axis {
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();

  double along(const Eigen::Vector3d& p) const { return (p - origin_m).dot(direction); }
  Eigen::Vector3d at(double t) const { return origin_m + t * direction; }
  /// From the foot of the perpendicular to p.
  Eigen::Vector3d across(const Eigen::Vector3d& p) const {
    const Eigen::Vector3d w = p - origin_m;
    return w - w.dot(direction) * direction;
  }
  double distance(const Eigen::Vector3d& p) const { return std::sqrt(across(p).squaredNorm()); }
};

struct Approach {
  double t = 0.0;  ///< along the first axis
  double u = 0.0;  ///< along the second
  double distance_m = 0.0;
};

/// Where `a` and `b` come nearest; parallel lines: at the origin of `a`.
inline Approach nearest(const Axis& a, const Axis& b) {
  const Eigen::Vector3d w = a.origin_m - b.origin_m;
  const double cosine = a.direction.dot(b.direction);
  const double denominator = 1.0 - cosine * cosine;
  const double wa = a.direction.dot(w);
  const double wb = b.direction.dot(w);
  Approach approach;
  if (denominator < 1e-6) {
    approach.u = wb;
  } else {
    approach.t = (cosine * wb - wa) / denominator;
    approach.u = (wb - cosine * wa) / denominator;
  }
  approach.distance_m = std::sqrt((a.at(approach.t) - b.at(approach.u)).squaredNorm());
  return approach;
}

/// v / |v|, or `fallback` when v has no length.
inline Eigen::Vector3d unit(const Eigen::Vector3d& v, const Eigen::Vector3d& fallback) {
  const double length = std::sqrt(v.squaredNorm());
  return length > 1e-9 ? Eigen::Vector3d(v / length) : fallback;
}

/// The level unit vector from `from` towards `to`: how a claw comes to a rung.
inline Eigen::Vector3d level_direction(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return unit({to.x() - from.x(), to.y() - from.y(), 0.0}, Eigen::Vector3d::UnitX());
}

}  // namespace ladder
