// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/plant/plant_params.h"

#include "base/check.h"

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

Eigen::Isometry3d starting_pose(const PlantParams& params) {
  // Body x up the ladder, z away from it.
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() << 0, 0, -1, 0, 1, 0, 1, 0, 0;
  pose.translation() =
      Eigen::Vector3d(params.ladder_x_m - params.stand_off_m, 0.0, params.body_height_m);
  return pose;
}

void place_legs(PlantParams& params) {
  const Eigen::Isometry3d T_world_body = starting_pose(params);
  const bool gripping = params.start == PlantStart::kGripping;
  for (int leg = 0; leg < kNumLegs; ++leg) {
    const LadderRung& rung =
        params.rungs[static_cast<std::size_t>(params.start_rung[static_cast<std::size_t>(leg)])];
    Eigen::Vector3d foot_world = 0.5 * (rung.end0_m + rung.end1_m);
    foot_world.y() = left_sign(leg) * params.foot_y_m;
    if (!gripping) foot_world.x() -= params.docked_gap_m;
    const auto angles = angles_for_foot(params.geometry, leg, T_world_body.inverse() * foot_world);
    CHECK(angles.has_value(), "the starting rungs must be within reach of the legs");
    for (int joint = 0; joint < 3; ++joint) {
      params.drives[static_cast<std::size_t>(axis_of(leg, joint))].start_rad = (*angles)[joint];
    }
    params.drives[static_cast<std::size_t>(axis_of(leg, 3))].start_rad =
        gripping ? Claw(params.claw).contact_rad(rung.radius_m) : params.claw.open_rad;
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
