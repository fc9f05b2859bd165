// SPDX-License-Identifier: BSD-3-Clause
// How a body without physics moves before its scene: it sways about where it stands and climbs at
// constant speed. A function of time alone.
#pragma once

#include <string>

#include <Eigen/Geometry>

#include "simulator/imu.h"

namespace simulator {

struct MotionParams {
  double sway_m = 0.0;    ///< amplitude, level, mostly sideways
  double sway_deg = 0.0;  ///< amplitude of the rotation about a slanting axis
  double sway_hz = 0.5;
  double climb_m_s = 0.0;  ///< upwards

  bool any() const { return sway_m != 0.0 || sway_deg != 0.0 || climb_m_s != 0.0; }
};

/// "" or the violated relation.
std::string check(const MotionParams& params);

/// Where a body is that stood at T_world_body at t = 0.
Eigen::Isometry3d moved(const MotionParams& params, const Eigen::Isometry3d& T_world_body,
                        double t_s);
BodyMotion motion_at(const MotionParams& params, const Eigen::Isometry3d& T_world_body, double t_s);

}  // namespace simulator
