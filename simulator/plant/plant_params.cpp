// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/plant/plant_params.h"

namespace simulator {
namespace {

/// Hard stops a little beyond the controller's joint limits.
DriveParams leg_drive(int axis) {
  DriveParams drive;
  drive.node_id = static_cast<std::uint8_t>(axis + 1);
  const bool front = leg_of(axis) < 2;
  switch (joint_of(axis)) {
    case 0:
      drive.motor.min_rad = -0.95;
      drive.motor.max_rad = 0.95;
      break;
    case 1:
      drive.motor.min_rad = -2.65;
      drive.motor.max_rad = 2.65;
      break;
    default:
      drive.motor.min_rad = front ? 0.10 : -2.75;
      drive.motor.max_rad = front ? 2.75 : -0.10;
  }
  return drive;
}

DriveParams jaw_drive(int axis, const ClawParams& claw) {
  DriveParams drive;
  drive.node_id = static_cast<std::uint8_t>(axis + 1);
  drive.motor.min_rad = claw.stop_rad;
  drive.motor.max_rad = 1.3;
  drive.motor.max_velocity_rad_s = 8.0;
  drive.motor.max_acceleration_rad_s2 = 300.0;
  drive.motor.inertia_kg_m2 = 0.004;
  drive.motor.peak_torque_Nm = 6.0;
  drive.rated_torque_Nm = 6.0;
  return drive;
}

}  // namespace

PlantParams::PlantParams() {
  for (int axis = 0; axis < kNumAxes; ++axis) {
    drives[static_cast<std::size_t>(axis)] = is_jaw(axis) ? jaw_drive(axis, claw) : leg_drive(axis);
  }
}

std::string check(const PlantParams& params) {
  for (const DriveParams& drive : params.drives) {
    const std::string problem = check(drive);
    if (!problem.empty()) return "node " + std::to_string(drive.node_id) + ": " + problem;
  }
  if (!(params.foot_stiffness_N_m > 0.0)) return "foot_stiffness_N_m must be > 0";
  if (!(params.dock_stiffness_N_m > 0.0)) return "dock_stiffness_N_m must be > 0";
  for (const int rung : params.start_rung) {
    if (rung < 0 || rung >= static_cast<int>(params.rungs.size())) {
      return "start_rung must be an index of rungs";
    }
  }
  return "";
}

}  // namespace simulator
