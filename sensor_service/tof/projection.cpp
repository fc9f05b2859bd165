// SPDX-License-Identifier: BSD-3-Clause
#include "tof/projection.h"

#include <cmath>

namespace tof {

void RayTable::fit(const DepthFrame& frame) {
  const auto width = static_cast<std::size_t>(frame.width_px);
  const auto height = static_cast<std::size_t>(frame.height_px);
  if (kind_ == frame.depth_kind && x_.size() == width && y_.size() == height &&
      intrinsics_ == frame.intrinsics) {
    return;
  }
  ++num_rebuilds_;
  kind_ = frame.depth_kind;
  intrinsics_ = frame.intrinsics;
  x_.resize(width);
  y_.resize(height);
  for (std::size_t c = 0; c < width; ++c) {
    x_[c] = static_cast<float>((static_cast<double>(c) - intrinsics_.cx_px) / intrinsics_.fx_px);
  }
  for (std::size_t r = 0; r < height; ++r) {
    y_[r] = static_cast<float>((static_cast<double>(r) - intrinsics_.cy_px) / intrinsics_.fy_px);
  }
  if (kind_ != DepthKind::kRadial) return;
  axial_share_.resize(width * height);
  for (std::size_t r = 0; r < height; ++r) {
    for (std::size_t c = 0; c < width; ++c) {
      const double x = x_[c];
      const double y = y_[r];
      axial_share_[r * width + c] = static_cast<float>(1.0 / std::sqrt(1.0 + x * x + y * y));
    }
  }
}

void project_row(const RowPixels& pixels, const RayTable& rays, const Placement& placement,
                 const PointsOut& out) {
  const Eigen::Matrix3f& R = placement.rotation;
  const Eigen::Vector3f& t = placement.position_m;
  const Eigen::Vector3f base = R.col(1) * rays.y(pixels.row) + R.col(2);
  const float base_x = base.x(), base_y = base.y(), base_z = base.z();
  const float step_x = R(0, 0), step_y = R(1, 0), step_z = R(2, 0);
  const float t_x = t.x(), t_y = t.y(), t_z = t.z();
  const float* ray_x = rays.x();
  const float* share = rays.axial_share(pixels.row);
  for (int i = 0; i < pixels.num_pixels; ++i) {
    const int c = pixels.column[i];
    float depth_m = static_cast<float>(pixels.depth_mm[i]) * 0.001F;
    if (share != nullptr) depth_m *= share[c];
    out.x_m[i] = t_x + depth_m * (base_x + step_x * ray_x[c]);
    out.y_m[i] = t_y + depth_m * (base_y + step_y * ray_x[c]);
    out.z_m[i] = t_z + depth_m * (base_z + step_z * ray_x[c]);
  }
}

}  // namespace tof
