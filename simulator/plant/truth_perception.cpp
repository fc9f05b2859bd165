// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/plant/truth_perception.h"

namespace simulator {
namespace {

constexpr float kVariance_m2 = 1e-6F;
constexpr float kFromEnd_m = 0.02F;

void add_rung(ladder_msgs::ladder_t& m, int index, const LadderRung& rung,
              const Eigen::Vector3d& odom_origin_m) {
  // End 0 is the left one, seen by the robot.
  const bool is_left_first = rung.end0_m.y() > rung.end1_m.y();
  const Eigen::Vector3d left_m = is_left_first ? rung.end0_m : rung.end1_m;
  const Eigen::Vector3d right_m = is_left_first ? rung.end1_m : rung.end0_m;
  const Eigen::Vector3f end0_m = (left_m - odom_origin_m).cast<float>();
  const Eigen::Vector3f end1_m = (right_m - odom_origin_m).cast<float>();
  m.rung_id.push_back(index);
  m.rung_state.push_back(ladder_msgs::ladder_t::RUNG_TRUSTED);
  m.rung_age.push_back(12);
  m.rung_confidence.push_back(1.0F);
  m.rung_evaluation.push_back(1.0F);
  m.rung_inliers.push_back(20);
  m.rung_outliers.push_back(0);
  m.rung_x0_m.push_back(end0_m.x());
  m.rung_y0_m.push_back(end0_m.y());
  m.rung_z0_m.push_back(end0_m.z());
  m.rung_x1_m.push_back(end1_m.x());
  m.rung_y1_m.push_back(end1_m.y());
  m.rung_z1_m.push_back(end1_m.z());
  m.rung_radius_m.push_back(static_cast<float>(rung.radius_m));
  m.rung_sag_m.push_back(0.0F);
  m.rung_flags.push_back(0);
  for (auto* variance : {&m.rung_cov_xx_m2, &m.rung_cov_yy_m2, &m.rung_cov_zz_m2}) {
    variance->push_back(kVariance_m2);
  }
  for (auto* covariance : {&m.rung_cov_xy_m2, &m.rung_cov_xz_m2, &m.rung_cov_yz_m2}) {
    covariance->push_back(0.0F);
  }
  m.interval_rung.push_back(m.num_rungs);
  m.interval_from_m.push_back(kFromEnd_m);
  m.interval_to_m.push_back((end1_m - end0_m).norm() - kFromEnd_m);
  m.interval_reason.push_back(ladder_msgs::ladder_t::REASON_NONE);
  ++m.num_rungs;
  ++m.num_intervals;
}

}  // namespace

ladder_msgs::ladder_t true_rungs(const RungWorld& world, const Eigen::Vector3d& odom_origin_m,
                                 std::int64_t utime_us) {
  ladder_msgs::ladder_t message{};
  message.utime = utime_us;
  message.ladder_state = ladder_msgs::ladder_t::LADDER_CONFIRMED;
  message.spacing_m = 0.30F;
  message.spacing_sigma_m = 0.001F;
  for (int index = 0; index < world.num_rungs(); ++index) {
    const LadderRung& rung = world.rung(index);
    if (!rung.broken) add_rung(message, index, rung, odom_origin_m);
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
