// SPDX-License-Identifier: BSD-3-Clause
// The result: points of all live heads in the odom frame. Mirrors point_cloud_t without its seq.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "tof/depth_frame.h"
#include "tof/head_schedule.h"
#include "tof/pose.h"
#include "tof/projection.h"

namespace tof {

enum class PoseSource : std::uint8_t {
  kUnknown = 0,  ///< neither is at hand: the last pose, or the identity, stands in
  kGravity = 1,  ///< orientation from the inertial unit, position 0
  kOdometry = 2,
};

/// x_m, y_m, z_m and head are parallel. Points are grouped by ascending head, row by row.
struct Cloud {
  std::int64_t utime_us = 0;                            ///< the newest head's
  std::array<std::int64_t, kNumHeads> head_utime_us{};  ///< 0 = gave none
  std::array<HeadState, kNumHeads> head_state{};
  std::array<Eigen::Vector3f, kNumHeads> head_position_m{};  ///< in odom, at its own time
  Pose T_odom_body;                                          ///< at utime
  PoseSource pose_source = PoseSource::kUnknown;  ///< the worst over the heads of this cloud
  float range_max_m = 0.0F;                       ///< the farthest of the heads
  float pixel_pitch_rad = 0.0F;                   ///< the coarsest of the heads
  std::vector<float> x_m, y_m, z_m;
  std::vector<std::uint8_t> head;

  std::size_t size() const { return x_m.size(); }
};

/// Keeps max_points of num_points by rank: point r stays when (r + 1) * max_points / num_points
/// passes a whole number. Even, and the same every time; all stay when they fit.
class RankThinning {
 public:
  RankThinning(std::int64_t num_points, std::int64_t max_points)
      : step_(num_points <= max_points ? 1 : max_points),
        period_(num_points <= max_points ? 1 : num_points) {}

  /// Of the next point; is_point false leaves the rank alone and returns false.
  bool keep(bool is_point) {
    phase_ += is_point ? step_ : 0;
    const bool is_kept = phase_ >= period_;
    phase_ -= is_kept ? period_ : 0;
    return is_kept;
  }

 private:
  std::int64_t step_;
  std::int64_t period_;
  std::int64_t phase_ = 0;
};

/// Appends the pixels of one head to a cloud, thinned. Keeps scratch for one row.
class CloudWriter {
 public:
  /// Makes the cloud's arrays num_points long; write() fills them from the front.
  void begin(Cloud& cloud, std::size_t num_points);

  struct Image {
    int head = 0;
    int width_px = 0, height_px = 0;
    const std::int16_t* depth_mm = nullptr;  ///< filtered
  };
  void write(const Image& image, const RayTable& rays, const Placement& placement,
             RankThinning& thinning);

  std::size_t num_written() const { return num_written_; }

 private:
  Cloud* cloud_ = nullptr;
  std::size_t num_written_ = 0;
  std::array<int, kMaxSide_px> column_{};
  std::array<std::int16_t, kMaxSide_px> depth_mm_{};
};

}  // namespace tof
