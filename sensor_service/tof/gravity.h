// SPDX-License-Identifier: BSD-3-Clause
// Which way is up, from accelerometer and gyroscope, for as long as nobody publishes a pose.
// Two angles of the three: nothing here knows or drifts in heading. Vectors only, so every
// attitude (pitch 90 deg on the ladder, upside-down) is like any other.
#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "tof/params.h"
#include "tof/pose.h"
#include "tof/time_history.h"

namespace tof {

/// One sample of the inertial unit, body frame.
struct ImuSample {
  std::int64_t utime_us = 0;
  Eigen::Vector3d accelerometer_m_s2 = Eigen::Vector3d::Zero();  ///< at rest +9.81 along up
  Eigen::Vector3d gyroscope_rad_s = Eigen::Vector3d::Zero();
};

/// Complementary filter on one vector: the specific force, turned back by the gyroscope and pulled
/// to the accelerometer. Unlike an angle it has no place where it gets stuck.
class Gravity {
 public:
  Gravity(const GravityParams& params, const PoseParams& history);

  /// False: not finite, too short or too long to show gravity, or not newer than the last sample.
  bool add(const ImuSample& sample);

  /// Unit vector up in the body frame at this time; none without samples near it.
  std::optional<Eigen::Vector3d> up_at(std::int64_t utime_us) const;

  /// The newest, however old; none before the first sample.
  std::optional<Eigen::Vector3d> newest_up() const;

  void clear();

 private:
  double weight_of(const Eigen::Vector3d& accelerometer_m_s2) const;

  GravityParams params_;
  std::int64_t utime_us_ = 0;
  double weight_sum_ = 0.0;  ///< of the samples so far: the start is their plain mean
  Eigen::Vector3d force_m_s2_ = Eigen::Vector3d::Zero();
  TimeHistory<Eigen::Vector3d> up_;
};

/// Odom without odometry: origin in the body, z up, heading fixed once. Later attitudes differ
/// from the first by the smallest rotation that explains them, so the heading depends on up alone
/// and cannot drift (nor can it follow a robot that turns on the spot: that needs odometry).
class GravityFrame {
 public:
  /// x of odom = horizontal part of view_body; a head that looks straight up or down points with
  /// its image's upper edge, given as image_up_body.
  void fix(const Eigen::Vector3d& up_body, const Eigen::Vector3d& view_body,
           const Eigen::Vector3d& image_up_body);
  bool is_fixed() const { return is_fixed_; }
  void clear() { is_fixed_ = false; }

  /// Needs fix() before.
  Eigen::Quaterniond q_odom_body(const Eigen::Vector3d& up_body) const;

 private:
  bool is_fixed_ = false;
  Eigen::Vector3d up_body_ = Eigen::Vector3d::UnitZ();
  Eigen::Quaterniond q_odom_body_ = Eigen::Quaterniond::Identity();
};

}  // namespace tof
