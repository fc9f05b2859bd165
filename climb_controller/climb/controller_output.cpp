// SPDX-License-Identifier: BSD-3-Clause
// The controller around its decisions: what it knows of the robot, targets through the gate,
// requests, report.
#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "climb/controller.h"

namespace climb {

using S = ControllerState;

LimbInput Controller::limb_input(const ControllerInput& input, Leg leg) const {
  LimbInput limb;
  for (int joint = 0; joint < kNumLegJoints; ++joint) {
    const AxisReading& axis = input.axes[axis_of(leg, joint)];
    limb.angles_rad[joint] = axis.position_rad;
    limb.torques_Nm[joint] = axis.torque_Nm;
  }
  limb.others_hold = true;
  for (const Leg other : kLegs) {
    const LimbCycle& cycle = limbs_[other];
    const bool holds = is_confirmed(cycle.state()) && cycle.confirmation().holds();
    if (other != leg && !holds) limb.others_hold = false;
  }
  const AxisReading& jaw = input.axes[axis_of(leg, kJaw)];
  limb.claw = {input.touch[leg], jaw.position_rad, jaw.torque_Nm};
  limb.T_odom_body = odometry_.estimate().T_odom_body();
  limb.dt_s = params_.gate.period_s;
  return limb;
}

LadderView Controller::ladder_of(const ControllerInput& input) const {
  LadderView ladder = goes_back() ? way_back_.view() : input.ladder;
  ladder.age_s = 1e-6 * static_cast<double>(input.now_us - input.ladder_received_us);
  return ladder;
}

RobotNow Controller::robot_now(const ControllerInput& input) const {
  RobotNow now;
  now.pose = odometry_.estimate();
  now.stance.up_body = q_odom_body_.conjugate() * Eigen::Vector3d::UnitZ();
  for (const Leg leg : kLegs) {
    now.stance.angles_rad[leg] = limb_input(input, leg).angles_rad;
    now.stance.contacts[leg].weight = limbs_[leg].target().weight;
    now.stance.contacts[leg].rung_id = limbs_[leg].rung_id();
    now.limbs[leg] = limbs_[leg].state();
  }
  return now;
}

void Controller::update_pose(const ControllerInput& input) {
  OdometryInput odometry;
  odometry.q_odom_body = input.imu.q_odom_body;
  odometry.dt_s = params_.gate.period_s;
  for (const Leg leg : kLegs) {
    odometry.angles_rad[leg] = limb_input(input, leg).angles_rad;
    odometry.weight[leg] = limbs_[leg].target().weight;
  }
  // In the dock the stand holds the body: odom begins there, and no error grows.
  if (!hangs_) {
    odometry_.reset();
    way_back_.clear();
  }
  odometry_.update(odometry);
}

std::optional<Leg> Controller::moving_leg() const {
  for (const Leg leg : kLegs) {
    if (limbs_[leg].moves()) return leg;
  }
  return std::nullopt;
}

void Controller::weigh_grips(const ControllerInput& input) {
  for (const Leg leg : kLegs) {
    grip_N_[leg] = 0.0;
    if (!is_confirmed(limbs_[leg].state())) continue;
    const LimbInput limb = limb_input(input, leg);
    // tau = -J^T f; a rung lies along the body's y.
    const Eigen::Matrix3d J = kinematics_.jacobian(leg, limb.angles_rad);
    const Eigen::Vector3d force_N = -(J.transpose().inverse() * limb.torques_Nm);
    grip_N_[leg] = std::hypot(force_N.x(), force_N.z());
  }
}

void Controller::send(const ControllerInput& input, ControllerOutput& output) {
  output.send = following_ && !action_.silent && gate_.started();
  if (!output.send) return;
  PerAxis<AxisCommand> wanted = gate_.sent();
  for (const Leg leg : kLegs) {
    const LimbTarget& target = limbs_[leg].target();
    for (int joint = 0; joint < kNumLegJoints; ++joint) {
      AxisCommand& axis = wanted[axis_of(leg, joint)];
      axis.position_rad = target.angles_rad[joint];
      axis.velocity_rad_s = target.velocity_rad_s[joint];
    }
    wanted[axis_of(leg, kJaw)].position_rad = target.jaw_rad;
  }
  if (params_.feed_forward) add_torques(input, wanted);
  verdict_ = gate_.pass(wanted, input.now_us, input.now_us);
  if (!verdict_.passed()) unsafe_ = true;
  output.axes = gate_.sent();
}

void Controller::add_torques(const ControllerInput& input, PerAxis<AxisCommand>& wanted) {
  // In the dock the stand bears the weight: it lets go, and takes over, little by little.
  const double part = params_.gate.period_s / params_.torque_ramp_s;
  torque_part_ = std::clamp(torque_part_ + (hangs_ && !parking_ ? part : -part), 0.0, 1.0);
  if (!hangs_) return;
  const Stance stance = robot_now(input).stance;
  const PerLeg<LegAngles> torques_Nm = support_.torques_Nm(stance, support_.distribute(stance));
  for (const Leg leg : kLegs) {
    for (int joint = 0; joint < kNumLegJoints; ++joint) {
      const int axis = axis_of(leg, joint);
      const double most_Nm = limits_[axis].max_torque_Nm;
      wanted[axis].torque_Nm = std::clamp(torque_part_ * torques_Nm[leg][joint], -most_Nm, most_Nm);
    }
  }
}

DriveRequest Controller::drive_request(const ControllerInput& input) const {
  switch (state_) {
    case S::kArming:
      return input.drives_enabled ? DriveRequest::kNone : DriveRequest::kEnable;
    case S::kEstop:
      return DriveRequest::kQuickStop;
    case S::kDisarming:
      return parking_ ? DriveRequest::kNone : DriveRequest::kDisable;
    case S::kDisarmed:
      return input.drives_enabled ? DriveRequest::kHold : DriveRequest::kNone;
    case S::kBoot:
    case S::kSelftest:
    case S::kHold:
    case S::kClimbing:
    case S::kPaused:
    case S::kProtectiveHold:
    case S::kFaultHold:
      return DriveRequest::kNone;
  }
  return DriveRequest::kNone;
}

void Controller::report(ControllerOutput& output) const {
  output.gate = verdict_;
  output.state = state_;
  output.reason = reason_;
  for (const Leg leg : kLegs) {
    output.limbs[leg] = limbs_[leg].state();
    output.rung_ids[leg] = std::max(-1, limbs_[leg].rung_id());  // a felt one has no number
  }
  output.body_shift = shift_.active();
  output.at_top = plan_.at_top;
  output.at_dock = at_dock_;
  output.putting_down = putting_down_.has_value();
  output.fall_alarm = lacks_grasps();
  output.grip_N = grip_N_;
  output.grip_alarm = false;
  for (const double grip_N : grip_N_) {
    if (!(grip_N <= params_.climb.support.grip_alarm_N)) output.grip_alarm = true;
  }
  output.rests_safely = rests_safely_;
  output.refusal = plan_.ready ? Refusal::kNone : plan_.refusal;
  output.burden = plan_.burden;
  output.pose = odometry_.estimate();
}

}  // namespace climb
