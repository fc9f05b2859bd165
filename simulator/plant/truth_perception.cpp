// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/plant/truth_perception.h"

namespace simulator {
void append(ladder_msgs::ladder_t& m, const ToldRung& rung) {
  m.interval_rung.push_back(m.num_rungs);
  m.interval_from_m.push_back(rung.from_end_m);
  m.interval_to_m.push_back((rung.right_m - rung.left_m).norm() - rung.from_end_m);
  m.interval_reason.push_back(ladder_msgs::ladder_t::REASON_NONE);
  ++m.num_intervals;
  m.rung_id.push_back(rung.id);
  m.rung_state.push_back(ladder_msgs::ladder_t::RUNG_TRUSTED);
  m.rung_age.push_back(12);
  m.rung_confidence.push_back(1.0F);
  m.rung_evaluation.push_back(1.0F);
  m.rung_inliers.push_back(20);
  m.rung_outliers.push_back(0);
  m.rung_x0_m.push_back(rung.left_m.x());
  m.rung_y0_m.push_back(rung.left_m.y());
  m.rung_z0_m.push_back(rung.left_m.z());
  m.rung_x1_m.push_back(rung.right_m.x());
  m.rung_y1_m.push_back(rung.right_m.y());
  m.rung_z1_m.push_back(rung.right_m.z());
  m.rung_radius_m.push_back(rung.radius_m);
  m.rung_sag_m.push_back(0.0F);
  m.rung_flags.push_back(rung.flags);
  for (auto* variance : {&m.rung_cov_xx_m2, &m.rung_cov_yy_m2, &m.rung_cov_zz_m2}) {
    variance->push_back(rung.sigma_m * rung.sigma_m);
  }
  for (auto* covariance : {&m.rung_cov_xy_m2, &m.rung_cov_xz_m2, &m.rung_cov_yz_m2}) {
    covariance->push_back(0.0F);
  }
  ++m.num_rungs;
}

ladder_msgs::ladder_t true_rungs(const RungWorld& world, const Eigen::Isometry3d& T_odom_world,
                                 std::int64_t utime_us) {
  ladder_msgs::ladder_t message{};
  message.utime = utime_us;
  message.ladder_state = ladder_msgs::ladder_t::LADDER_CONFIRMED;
  message.spacing_m = 0.30F;
  message.spacing_sigma_m = 0.001F;
  for (int index = 0; index < world.num_rungs(); ++index) {
    const LadderRung& rung = world.rung(index);
    if (rung.broken) continue;
    const bool is_left_first = rung.end0_m.y() > rung.end1_m.y();
    ToldRung told;
    told.id = index;
    const Eigen::Vector3d& left_m = is_left_first ? rung.end0_m : rung.end1_m;
    const Eigen::Vector3d& right_m = is_left_first ? rung.end1_m : rung.end0_m;
    told.left_m = (T_odom_world * left_m).cast<float>();
    told.right_m = (T_odom_world * right_m).cast<float>();
    told.radius_m = static_cast<float>(rung.radius_m);
    append(message, told);
  }
  return message;
}

ladder_msgs::imu_t imu_message(const ImuReading& reading, std::int64_t utime_us) {
  ladder_msgs::imu_t message{};
  message.utime = utime_us;
  for (int i = 0; i < 3; ++i) {
    message.accelerometer_m_s2[i] = reading.specific_force_m_s2[i];
    message.gyroscope_rad_s[i] = reading.angular_rate_rad_s[i];
  }
  return message;
}

}  // namespace simulator
