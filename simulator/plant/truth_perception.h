// SPDX-License-Identifier: BSD-3-Clause
// What perception and the inertial unit would say of the plant, without a camera: for runs of the
// controller where nothing but its own behaviour is looked at.
#pragma once

#include <cstdint>

#include <Eigen/Geometry>

#include "ladder_msgs/imu_t.hpp"
#include "ladder_msgs/ladder_t.hpp"
#include "simulator/plant/robot_plant.h"

namespace simulator {

/// A rung as perception tells it that is sure of it.
struct ToldRung {
  int id = 0;
  Eigen::Vector3f left_m, right_m;  ///< its ends, odom, as the robot sees them
  float radius_m = 0.0F;
  float sigma_m = 0.001F;    ///< of each coordinate
  float from_end_m = 0.02F;  ///< graspable but for so much at each end
  std::int16_t flags = 0;
};

/// Appends a trusted rung with one graspable stretch.
void append(ladder_msgs::ladder_t& message, const ToldRung& rung);

/// Every whole rung, trusted, at its true place (1 mm of error told), graspable up to 20 mm from
/// its ends; ids are the rungs' indices.
ladder_msgs::ladder_t true_rungs(const RungWorld& world, const Eigen::Isometry3d& T_odom_world,
                                 std::int64_t utime_us);

ladder_msgs::imu_t imu_message(const ImuReading& reading, std::int64_t utime_us);

}  // namespace simulator
