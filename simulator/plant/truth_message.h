// SPDX-License-Identifier: BSD-3-Clause
// The plant's truth as the message of LADDER_TRUTH: where the body is and which rungs are whole.
#pragma once

#include <cstdint>

#include <Eigen/Geometry>

#include "ladder_msgs/truth_t.hpp"
#include "simulator/plant/robot_plant.h"

namespace simulator {

/// Odom has its origin where the body was at the start, its axes parallel to the world's. Broken
/// rungs are left out; ids are the rungs' indices.
ladder_msgs::truth_t truth_message(const PlantTruth& truth, const RungWorld& world,
                                   const Eigen::Vector3d& odom_origin_m, std::int64_t utime_us);

}  // namespace simulator
