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

/// Every whole rung, trusted, at its true place (1 mm of error told), graspable up to 20 mm from
/// its ends. Odom as in truth_message(); ids are the rungs' indices.
ladder_msgs::ladder_t true_rungs(const RungWorld& world, const Eigen::Vector3d& odom_origin_m,
                                 std::int64_t utime_us);

ladder_msgs::imu_t imu_message(const ImuReading& reading, std::int64_t utime_us);

}  // namespace simulator
