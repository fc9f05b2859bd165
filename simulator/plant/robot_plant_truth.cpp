// SPDX-License-Identifier: BSD-3-Clause
// What the plant tells its observers, and what is done to it from outside.
#include <algorithm>

#include "simulator/plant/robot_plant.h"

namespace simulator {
namespace {

constexpr double kAccelerometerSigma_m_s2 = 0.02;
constexpr double kGyroscopeSigma_rad_s = 0.002;

}  // namespace

PlantTruth RobotPlant::truth() const {
  PlantTruth truth;
  truth.time_us = now_us_;
  truth.T_world_body = T_world_body();
  truth.docked = mechanics_->docked();
  truth.fallen = mechanics_->fallen();
  truth.lines = lines();
  for (int leg = 0; leg < kNumLegs; ++leg) {
    truth.legs[static_cast<std::size_t>(leg)] = mechanics_->leg(leg);
  }
  for (int axis = 0; axis < kNumAxes; ++axis) {
    const auto index = static_cast<std::size_t>(axis);
    truth.joint_rad[index] = drive(axis).measured_rad();
    truth.joint_rad_s[index] = drive(axis).motor().velocity_rad_s();
    truth.joint_Nm[index] = drive(axis).motor().torque_Nm();
    truth.power[index] = drive(axis).power_state();
  }
  const auto rungs = world_.rungs();
  truth.num_broken_rungs = static_cast<int>(std::count_if(
      rungs.begin(), rungs.end(), [](const LadderRung& rung) { return rung.broken; }));
  return truth;
}

ImuReading RobotPlant::imu() {
  const BodyMotion& body = mechanics_->body();
  ImuReading reading;
  reading.specific_force_m_s2 = body.specific_force_m_s2;
  reading.angular_rate_rad_s = body.angular_rate_rad_s;
  for (int i = 0; i < 3; ++i) {
    reading.specific_force_m_s2[i] += kAccelerometerSigma_m_s2 * noise_.gaussian();
    reading.angular_rate_rad_s[i] += kGyroscopeSigma_rad_s * noise_.gaussian();
  }
  reading.q_world_body = Eigen::Quaterniond(body.T_world_body.linear());
  return reading;
}

void RobotPlant::inject(int axis, std::uint16_t fault_code) {
  drive(axis).raise_fault(fault_code, sent_);
  flush(port(axis), now_us_);
}

void RobotPlant::warn(int axis, std::uint16_t code) {
  drive(axis).raise_warning(code, sent_);
  flush(port(axis), now_us_);
}

void RobotPlant::clear_warning(int axis) {
  drive(axis).clear_warning(sent_);
  flush(port(axis), now_us_);
}

void RobotPlant::reboot(int axis) {
  drive(axis).reboot(now_us_);
}

void RobotPlant::drop_to_pre_operational(int axis) {
  drive(axis).drop_to_pre_operational(sent_);
  flush(port(axis), now_us_);
}

}  // namespace simulator
