// SPDX-License-Identifier: BSD-3-Clause
// Depth frames for tests: owns the pixels that a DepthFrame only views.
#pragma once

#include <cmath>
#include <vector>

#include "tof/depth_frame.h"

namespace tof_test {

inline constexpr std::int64_t kStart_us = 1'700'000'000'000'000;
inline constexpr std::int64_t kPeriod_us = 66'667;

/// Head looks along body x, upright: head z = body x, head x = -body y, head y = -body z.
inline Eigen::Quaterniond looking_ahead() {
  return {0.5, -0.5, 0.5, -0.5};
}

/// Rotation by an angle about an axis; tests may use trigonometry.
inline Eigen::Quaterniond turn(double angle_rad, const Eigen::Vector3d& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, axis.normalized()));
}

struct FrameBuilder {
  int width = 4;
  int height = 3;
  std::vector<std::int16_t> depth_mm;
  std::vector<std::uint8_t> confidence;
  tof::DepthFrame frame;

  FrameBuilder() : FrameBuilder(4, 3, 1000) {}
  FrameBuilder(int width_px, int height_px, std::int16_t all_mm)
      : width(width_px), height(height_px) {
    depth_mm.assign(static_cast<std::size_t>(width * height), all_mm);
    frame.utime_us = kStart_us;
    frame.depth_kind = tof::DepthKind::kZ;
    frame.intrinsics = {200.0, 210.0, (width - 1) / 2.0, (height - 1) / 2.0};
    frame.range_min_m = 0.1;
    frame.range_max_m = 4.0;
    frame.T_body_head.q = looking_ahead();
  }

  std::int16_t& at(int row, int column) { return depth_mm[row * width + column]; }

  /// The view is valid while this builder lives and its vectors are not resized.
  tof::DepthFrame view() {
    frame.width_px = width;
    frame.height_px = height;
    frame.depth_mm = depth_mm;
    frame.confidence = confidence;
    return frame;
  }

  tof::DepthFrame view(int head, std::int64_t utime_us, std::int64_t seq) {
    frame.head = head;
    frame.utime_us = utime_us;
    frame.seq = seq;
    return view();
  }
};

}  // namespace tof_test
