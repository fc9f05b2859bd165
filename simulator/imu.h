// SPDX-License-Identifier: BSD-3-Clause
// The inertial unit of a body at rest: gravity's reaction and noise.
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

/// Depends on (seed, index) alone.
ImuSample imu_at_rest(const ImuParams& params, const Eigen::Isometry3d& T_world_body,
                      std::uint64_t seed, std::uint64_t index);

}  // namespace simulator
