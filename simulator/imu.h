// SPDX-License-Identifier: BSD-3-Clause
// The inertial unit of a body: gravity's reaction, how it moves, and noise.
#pragma once

#include <cstdint>

#include <Eigen/Geometry>

namespace simulator {

struct ImuParams {
  double accelerometer_sigma_m_s2 = 0.02;  ///< per sample and axis
  double gyroscope_sigma_rad_s = 0.002;
};

struct ImuSample {
  Eigen::Vector3d accelerometer_m_s2 = Eigen::Vector3d::Zero();  ///< body frame, specific force
  Eigen::Vector3d gyroscope_rad_s = Eigen::Vector3d::Zero();
};

/// How a body moves at one moment.
struct BodyMotion {
  Eigen::Vector3d acceleration_m_s2 = Eigen::Vector3d::Zero();   ///< world frame
  Eigen::Vector3d angular_rate_rad_s = Eigen::Vector3d::Zero();  ///< body frame
};

/// The noise depends on (seed, index) alone.
ImuSample imu_at_rest(const ImuParams& params, const Eigen::Isometry3d& T_world_body,
                      std::uint64_t seed, std::uint64_t index);
/// The same sample of a body that moves.
void add_motion(const BodyMotion& motion, const Eigen::Isometry3d& T_world_body, ImuSample& sample);

}  // namespace simulator
