// SPDX-License-Identifier: BSD-3-Clause
#include "climb_controller/drive_layout.h"

#include "climb/safety.h"

namespace climb_controller {
namespace {
constexpr double kJawAcceleration_rad_s2 = 300.0;  // full speed within two cycles

/// What does not depend on the protocol.
void lay_out(const DriveLayout& layout, const climb::ClimbParams& climb, can::BusParams& bus) {
  bus.cycle_us = static_cast<std::int64_t>(climb.motion.period_s * 1e6 + 0.5);
  const climb::PerAxis<climb::AxisLimits> limits = climb::axis_limits(climb.robot);
  const climb::RobotParams& robot = climb.robot;
  const climb::JointLimits* joints[] = {&robot.abduction, &robot.hip, &robot.knee_bend};
  for (int axis = 0; axis < climb::kNumAxes; ++axis) {
    const int joint = axis % climb::kNumAxesPerLeg;
    const DriveKind& kind = joint == climb::kJaw ? layout.jaw : layout.joint;
    can::AxisConfig config;
    config.node_id = static_cast<std::uint8_t>(layout.node_id[axis]);
    config.sign = layout.sign[axis];
    config.offset_rad = layout.offset_rad[axis];
    config.counts_per_rad = kind.counts_per_rad;
    config.gear = kind.gear;
    config.min_rad = limits[axis].min_rad;
    config.max_rad = limits[axis].max_rad;
    config.max_velocity_rad_s = limits[axis].max_velocity_rad_s;
    config.max_torque_Nm = limits[axis].max_torque_Nm;
    config.rated_torque_Nm = kind.rated_torque_Nm;
    config.max_acceleration_rad_s2 =
        joint == climb::kJaw ? kJawAcceleration_rad_s2 : joints[joint]->max_acceleration_rad_s2;
    config.quick_stop_rad_s2 = kind.quick_stop_rad_s2;
    config.following_error_rad = kind.following_error_rad;
    config.following_error_ms = kind.following_error_ms;
    config.has_torque = kind.has_torque;
    config.max_current_A = kind.max_current_A;
    bus.axes.push_back(config);
  }
}

}  // namespace

can::Cia402Params servo_bus_params(const DriveLayout& layout, const climb::ClimbParams& climb) {
  can::Cia402Params bus;
  lay_out(layout, climb, bus);
  return bus;
}

can::OdriveParams odrive_bus_params(const DriveLayout& layout, const climb::ClimbParams& climb) {
  can::OdriveParams bus;
  lay_out(layout, climb, bus);
  return bus;
}

}  // namespace climb_controller
