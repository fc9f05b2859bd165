// SPDX-License-Identifier: BSD-3-Clause
// Faults that the controller finds in its own input: drives that do not follow, tilt, free fall,
// a silent IMU or perception, touch switches. What bus and lines find comes in as flags.
#pragma once

#include <string>

#include "climb/controller_io.h"

namespace climb {

struct WatchParams {
  double period_s = 0.01;
  double max_following_rad = 0.30;  ///< of a leg's joint, two cycles (own: 2.5 rad/s and 60 ms lag)
  double jump_margin_rad = 0.05;    ///< beyond v T in one cycle (own)
  double min_upright_cosine = 0.9659;  ///< cos 15 deg, against where it was armed (contract)
  double free_fall_m_s2 = 2.94;        ///< 0.3 g (contract)
  double free_fall_s = 0.05;
  std::int64_t max_ladder_age_us = 300'000;
};

/// Heard, finite, and its orientation is a rotation.
bool is_sound(const ImuReading& imu);

/// "" or the violated relation, naming the field.
std::string check(const WatchParams& params);

class FaultWatch {
 public:
  FaultWatch(const PerAxis<AxisLimits>& limits, const WatchParams& params);

  /// From here on: upright is as it is now, and drives must follow.
  void arm(const ControllerInput& input);
  void disarm() { armed_ = false; }

  /// `sent` = the targets of the last cycle.
  FaultFlags look(const ControllerInput& input, const PerAxis<AxisCommand>& sent);

 private:
  bool look_at_drives(const ControllerInput& input, const PerAxis<AxisCommand>& sent);
  FaultFlags look_at_imu(const ImuReading& imu);

  PerAxis<AxisLimits> limits_;
  WatchParams params_;
  bool armed_ = false;
  PerAxis<double> last_rad_{};
  PerAxis<int> num_behind_{};
  Eigen::Vector3d up_body_ = Eigen::Vector3d::UnitX();
  double falling_s_ = 0.0;
};

}  // namespace climb
