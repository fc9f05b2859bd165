// SPDX-License-Identifier: BSD-3-Clause
// From pixels to points: the ray of every pixel from a table, then one rigid motion.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "tof/depth_frame.h"
#include "tof/pose.h"

namespace tof {

/// Rays of a pinhole camera. The ray through pixel (column, row) has direction (x[column], y[row],
/// 1): two short tables instead of one per pixel. Radial depth needs the ray's length too.
class RayTable {
 public:
  /// Rebuilt only when something changed.
  void fit(const DepthFrame& frame);

  const float* x() const { return x_.data(); }
  float y(int row) const { return y_[row]; }

  /// Axial distance / delivered distance of a row's pixels; null for DepthKind::kZ, where it is 1.
  const float* axial_share(int row) const {
    return kind_ == DepthKind::kRadial ? axial_share_.data() + row * x_.size() : nullptr;
  }

  int num_rebuilds() const { return num_rebuilds_; }

 private:
  Intrinsics intrinsics_;
  DepthKind kind_ = DepthKind::kUnknown;
  std::vector<float> x_, y_;
  std::vector<float> axial_share_;  ///< 1 / length of the ray, per pixel
  int num_rebuilds_ = 0;
};

/// A pose in the form that points are moved with.
struct Placement {
  explicit Placement(const Pose& T_odom_head)
      : rotation(T_odom_head.q.toRotationMatrix().cast<float>()),
        position_m(T_odom_head.p_m.cast<float>()) {}
  Eigen::Matrix3f rotation;
  Eigen::Vector3f position_m;
};

/// Pixels of one row that become points: parallel, in ascending column.
struct RowPixels {
  int row = 0;
  int num_pixels = 0;
  const int* column = nullptr;
  const std::int16_t* depth_mm = nullptr;
};

/// Where num_pixels points go.
struct PointsOut {
  float* x_m = nullptr;
  float* y_m = nullptr;
  float* z_m = nullptr;
};

void project_row(const RowPixels& pixels, const RayTable& rays, const Placement& placement,
                 const PointsOut& out);

}  // namespace tof
