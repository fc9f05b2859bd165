// SPDX-License-Identifier: BSD-3-Clause
// The half of the controller behind its decisions: targets through the gate, requests, report.
#include <algorithm>

#include "climb/controller.h"

namespace climb {

using S = ControllerState;

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

void Controller::add_torques(const ControllerInput& input, PerAxis<AxisCommand>& wanted) const {
  // In the dock the stand bears the weight.
  if (!was_docked_ || !input.imu.valid) return;
  const Stance stance = robot_now(input).stance;
  const PerLeg<LegAngles> torques_Nm = support_.torques_Nm(stance, support_.distribute(stance));
  for (const Leg leg : kLegs) {
    for (int joint = 0; joint < kNumLegJoints; ++joint) {
      const int axis = axis_of(leg, joint);
      const double most_Nm = limits_[axis].max_torque_Nm;
      wanted[axis].torque_Nm = std::clamp(torques_Nm[leg][joint], -most_Nm, most_Nm);
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
      return DriveRequest::kDisable;
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
    output.rung_ids[leg] = limbs_[leg].rung_id();
  }
  output.body_shift = shift_.active();
  output.at_top = plan_.at_top;
  output.refusal = plan_.ready ? Refusal::kNone : plan_.refusal;
  output.burden = plan_.burden;
  output.pose = odometry_.estimate();
}

}  // namespace climb
