// SPDX-License-Identifier: BSD-3-Clause
#include "tof/pose.h"

#include <cmath>

namespace tof {
namespace {

constexpr double kMaxCoordinate_m = 1e4;
constexpr double kUnitTolerance = 1e-3;
constexpr double kTiny = 1e-9;

}  // namespace

bool is_sound(const Pose& pose) {
  for (int i = 0; i < 3; ++i) {
    if (!(pose.p_m[i] >= -kMaxCoordinate_m && pose.p_m[i] <= kMaxCoordinate_m)) return false;
  }
  const double length = std::sqrt(pose.q.coeffs().squaredNorm());
  return length >= 1.0 - kUnitTolerance && length <= 1.0 + kUnitTolerance;
}

Pose operator*(const Pose& T_a_b, const Pose& T_b_c) {
  Pose T_a_c;
  T_a_c.p_m = T_a_b.p_m + T_a_b.q.toRotationMatrix() * T_b_c.p_m;
  T_a_c.q = T_a_b.q * T_b_c.q;
  return T_a_c;
}

Pose interpolate(const Pose& a, const Pose& b, double fraction) {
  Pose result;
  result.p_m = a.p_m + fraction * (b.p_m - a.p_m);
  // q and -q are the same rotation: take the one nearer to a.
  const double sign = a.q.coeffs().dot(b.q.coeffs()) < 0.0 ? -1.0 : 1.0;
  const Eigen::Vector4d sum = a.q.coeffs() + fraction * (sign * b.q.coeffs() - a.q.coeffs());
  const double length = std::sqrt(sum.squaredNorm());
  result.q.coeffs() = length > kTiny ? Eigen::Vector4d(sum / length) : b.q.coeffs();
  return result;
}

Eigen::Vector3d interpolate(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double fraction) {
  const Eigen::Vector3d sum = a + fraction * (b - a);
  const double length = std::sqrt(sum.squaredNorm());
  return length > kTiny ? Eigen::Vector3d(sum / length) : b;
}

Eigen::Quaterniond smallest_rotation(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const double cosine = from.dot(to);
  if (cosine < -1.0 + kTiny) {
    // Half a turn about the axis that is most across.
    const Eigen::Vector3d across =
        std::abs(from.x()) < 0.7 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
    const Eigen::Vector3d axis = from.cross(across);
    const Eigen::Vector3d unit = axis / std::sqrt(axis.squaredNorm());
    return {0.0, unit.x(), unit.y(), unit.z()};
  }
  const Eigen::Vector3d axis = from.cross(to);
  const double w = 1.0 + cosine;
  const double length = std::sqrt(w * w + axis.squaredNorm());
  return {w / length, axis.x() / length, axis.y() / length, axis.z() / length};
}

}  // namespace tof
