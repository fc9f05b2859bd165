// SPDX-License-Identifier: BSD-3-Clause
// The body's orientation in odom from accelerometer and gyroscope. Up is the specific force, turned
// back by the gyroscope and drawn to the accelerometer; the heading is fixed once (odom's y = the
// body's left) and follows from up by the smallest rotation since, so it cannot drift. That suits a
// robot whose claws keep it from turning on the spot; nothing here could see such a turn.
#pragma once

#include <cstdint>
#include <string>

#include <Eigen/Geometry>

namespace climb {

struct AttitudeParams {
  double time_constant_s = 0.5;  ///< > 0; the gyroscope serves below it
  double gravity_m_s2 = 9.81;
  double trust_m_s2 = 2.0;  ///< > 0; |length - gravity| at which a sample has no weight left
  double max_gap_s = 0.5;   ///< > 0; a longer silence begins anew
};

/// "" or the violated relation, naming the field.
std::string check(const AttitudeParams& params);

/// One sample, body frame.
struct ImuSample {
  std::int64_t utime_us = 0;
  Eigen::Vector3d accelerometer_m_s2 = Eigen::Vector3d::Zero();  ///< at rest +9.81 along up
  Eigen::Vector3d gyroscope_rad_s = Eigen::Vector3d::Zero();
};

class Attitude {
 public:
  explicit Attitude(const AttitudeParams& params) : params_(params) {}

  /// False: not finite, or not newer than the last one.
  bool add(const ImuSample& sample);

  /// Up is known.
  bool is_known() const { return is_known_; }
  const Eigen::Quaterniond& q_odom_body() const { return q_odom_body_; }

 private:
  void start(const Eigen::Vector3d& up_body);
  void fix_heading();

  AttitudeParams params_;
  bool is_known_ = false;
  bool has_heading_ = false;
  std::int64_t utime_us_ = 0;
  Eigen::Vector3d up_body_ = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d first_up_body_ = Eigen::Vector3d::UnitZ();
  Eigen::Quaterniond first_q_odom_body_ = Eigen::Quaterniond::Identity();
  Eigen::Quaterniond q_odom_body_ = Eigen::Quaterniond::Identity();
};

}  // namespace climb
