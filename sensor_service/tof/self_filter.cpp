// SPDX-License-Identifier: BSD-3-Clause
#include "tof/self_filter.h"

#include <algorithm>
#include <cmath>

namespace tof {
namespace {

using Eigen::Vector3d;

/// Columns and rows, both ends included.
struct Window {
  int left, right, top, bottom;
};

/// In the head's frame.
struct SeenCapsule {
  Vector3d from_m;
  Vector3d along_m;
  double inverse_length2;
  double radius2_m2;
  double nearest_m, farthest_m;  // its depths, a micrometre more

  bool may_hold(double z_m) const { return z_m >= nearest_m && z_m <= farthest_m; }
  bool holds(const Vector3d& p_m) const {
    const Vector3d off_m = p_m - from_m;
    const double share = std::clamp(off_m.dot(along_m) * inverse_length2, 0.0, 1.0);
    return (off_m - share * along_m).squaredNorm() <= radius2_m2;
  }
};

int clamped(double value, int size) {
  return static_cast<int>(std::clamp(std::floor(value), 0.0, static_cast<double>(size - 1)));
}

/// The part of the image in which the capsule may be; empty (left > right) when behind the head.
Window window_of(const DepthFrame& frame, const Vector3d& a_m, const Vector3d& b_m, double r_m) {
  const double nearest_m = std::min(a_m.z(), b_m.z()) - r_m;
  if (std::max(a_m.z(), b_m.z()) + r_m <= 0.0) return {1, 0, 1, 0};
  const Window all = {0, frame.width_px - 1, 0, frame.height_px - 1};
  constexpr double kTooNear_m = 0.01;
  if (nearest_m < kTooNear_m) return all;
  const Intrinsics& k = frame.intrinsics;
  Window window = {frame.width_px, -1, frame.height_px, -1};
  for (const Vector3d& end_m : {a_m, b_m}) {
    // A ball's outline lies within that of the box round it, seen from its near side and far side.
    for (const double z_m : {end_m.z() - r_m, end_m.z() + r_m}) {
      window.left = std::min(window.left,
                             clamped(k.cx_px + k.fx_px * (end_m.x() - r_m) / z_m, frame.width_px));
      window.right = std::max(
          window.right, clamped(k.cx_px + k.fx_px * (end_m.x() + r_m) / z_m + 1.0, frame.width_px));
      window.top = std::min(window.top,
                            clamped(k.cy_px + k.fy_px * (end_m.y() - r_m) / z_m, frame.height_px));
      window.bottom =
          std::max(window.bottom,
                   clamped(k.cy_px + k.fy_px * (end_m.y() + r_m) / z_m + 1.0, frame.height_px));
    }
  }
  return window;
}

int drop(const RayTable& rays, const Window& window, const SeenCapsule& capsule, int width_px,
         FilteredImage& image) {
  int num_dropped = 0;
  for (int row = window.top; row <= window.bottom; ++row) {
    const float* axial_share = rays.axial_share(row);
    for (int column = window.left; column <= window.right; ++column) {
      std::int16_t& depth_mm = image.depth_mm[static_cast<std::size_t>(row * width_px + column)];
      if (depth_mm == 0) continue;
      const double share = axial_share != nullptr ? static_cast<double>(axial_share[column]) : 1.0;
      const double z_m = 1e-3 * depth_mm * share;
      if (!capsule.may_hold(z_m)) continue;  // most of what is behind a limb: the ladder, the wall
      const Vector3d p_m(static_cast<double>(rays.x()[column]) * z_m,
                         static_cast<double>(rays.y(row)) * z_m, z_m);
      if (!capsule.holds(p_m)) continue;
      depth_mm = 0;
      ++num_dropped;
    }
  }
  return num_dropped;
}

}  // namespace

int drop_limbs(const DepthFrame& frame, const RayTable& rays, const Limbs& limbs,
               FilteredImage& image) {
  const Eigen::Matrix3d R_head_body = frame.T_body_head.q.toRotationMatrix().transpose();
  int num_dropped = 0;
  for (const Capsule& limb : limbs) {
    const Vector3d from_m = R_head_body * (limb.from_m - frame.T_body_head.p_m);
    const Vector3d to_m = R_head_body * (limb.to_m - frame.T_body_head.p_m);
    const Vector3d along_m = to_m - from_m;
    const double length2 = along_m.squaredNorm();
    const double reach_m = limb.radius_m + 1e-6;
    const SeenCapsule capsule = {from_m,
                                 along_m,
                                 length2 > 0.0 ? 1.0 / length2 : 0.0,
                                 limb.radius_m * limb.radius_m,
                                 std::min(from_m.z(), to_m.z()) - reach_m,
                                 std::max(from_m.z(), to_m.z()) + reach_m};
    const Window window = window_of(frame, from_m, to_m, limb.radius_m);
    num_dropped += drop(rays, window, capsule, frame.width_px, image);
  }
  image.num_kept -= num_dropped;
  return num_dropped;
}

}  // namespace tof
