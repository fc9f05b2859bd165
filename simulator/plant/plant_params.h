// SPDX-License-Identifier: BSD-3-Clause
// The whole plant's constants; the numbers come from the simulated robot with real contacts unless
// marked own.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "simulator/plant/claw.h"
#include "simulator/plant/drive.h"
#include "simulator/plant/plant_kinematics.h"
#include "simulator/plant/rung_world.h"

namespace simulator {

enum class PlantStart : std::uint8_t {
  kDocked,    ///< held by the dock, claws open 60 mm before their rungs
  kGripping,  ///< claws closed on their rungs, no dock
};

struct PlantParams {
  RobotGeometry geometry;
  ClawParams claw;
  std::vector<LadderRung> rungs = straight_ladder({});
  std::array<DriveParams, kNumAxes> drives;
  double foot_stiffness_N_m = 24'000.0;  ///< of one leg with its servos (own: 800 Nm/rad at 0.18 m)
  double dock_stiffness_N_m = 20'000.0;  ///< at each of the four hips (own)
  double weight_N = 78.5;
  double ladder_x_m = 0.0;      ///< of the ladder's plane
  double stand_off_m = 0.28;    ///< body origin before the rungs at the start
  double body_height_m = 0.60;  ///< of the origin at the start
  double foot_y_m = 0.15;
  double docked_gap_m = 0.06;  ///< claws before their rungs
  PlantStart start = PlantStart::kDocked;
  std::array<int, kNumLegs> start_rung = {2, 2, 0, 0};  ///< index per leg
  /// Hardware E-stop chain: torque off so long after the line opens; none = the line is only read.
  std::optional<std::int64_t> estop_cuts_torque_us;
  bool has_force_nodes = false;  ///< nodes 0x21..0x24
  std::uint64_t seed = 1;        ///< of the IMU's noise

  PlantParams();
};

/// "" or the violated relation.
std::string check(const PlantParams& params);

/// The body at the start, in the dock or hanging.
Eigen::Isometry3d starting_pose(const PlantParams& params);

/// Sets the drives' starting angles: feet at their rungs, or before them in the dock. The rungs
/// must be within reach (CHECK). params pass check().
void place_legs(PlantParams& params);

}  // namespace simulator
