// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/imu.h"

#include "base/rng.h"

namespace simulator {

ImuSample imu_at_rest(const ImuParams& params, const Eigen::Isometry3d& T_world_body,
                      std::uint64_t seed, std::uint64_t index) {
  constexpr double kGravity_m_s2 = 9.81;
  base::Rng rng(seed, index);
  ImuSample sample;
  sample.accelerometer_m_s2 = T_world_body.linear().transpose().col(2) * kGravity_m_s2;
  for (int axis = 0; axis < 3; ++axis) {
    sample.accelerometer_m_s2[axis] += params.accelerometer_sigma_m_s2 * rng.gaussian();
    sample.gyroscope_rad_s[axis] = params.gyroscope_sigma_rad_s * rng.gaussian();
  }
  return sample;
}

void add_motion(const BodyMotion& motion, const Eigen::Isometry3d& T_world_body,
                ImuSample& sample) {
  sample.accelerometer_m_s2 += T_world_body.linear().transpose() * motion.acceleration_m_s2;
  sample.gyroscope_rad_s += motion.angular_rate_rad_s;
}

}  // namespace simulator
