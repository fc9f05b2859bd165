// SPDX-License-Identifier: BSD-3-Clause
#include "climb_controller/convert.h"

#include <cmath>

namespace climb_controller {
namespace {

using ladder_msgs::climb_state_t;
using ladder_msgs::command_t;

// In the messages 0 is "unknown", so each enumerator is one more there; the ends are compared here.
template <class Enum>
constexpr std::int8_t told(Enum value) {
  return static_cast<std::int8_t>(static_cast<int>(value) + 1);
}
static_assert(told(climb::ControllerState::kBoot) == climb_state_t::STATE_BOOT);
static_assert(told(climb::ControllerState::kDisarming) == climb_state_t::STATE_DISARMING);
static_assert(told(climb::LimbState::kLoaded) == climb_state_t::LIMB_LOADED);
static_assert(told(climb::LimbState::kSupportLost) == climb_state_t::LIMB_SUPPORT_LOST);
static_assert(told(climb::Refusal::kNone) == climb_state_t::REFUSAL_NONE);
static_assert(told(climb::Refusal::kRungMissing) == climb_state_t::REFUSAL_RUNG_MISSING);
static_assert(told(climb::Burden::kBorne) == climb_state_t::BURDEN_BORNE);
static_assert(told(climb::Burden::kTorque) == climb_state_t::BURDEN_TORQUE);
static_assert(told(climb::CommandVerdict::kNotNow) == climb_state_t::VERDICT_NOT_NOW);
static_assert(told(Policy::kNone) == climb_state_t::POLICY_NONE);
static_assert(told(Policy::kNoPowerOffHold) == climb_state_t::POLICY_NO_POWER_OFF_HOLD);
static_assert(told(can::BusPhase::kFaulted) == climb_state_t::BUS_FAULTED);
static_assert(static_cast<int>(can::DriveState::kFault) == climb_state_t::DRIVE_FAULT);
static_assert(static_cast<int>(climb::Order::kDisarm) == command_t::ORDER_DISARM);

std::int8_t told(climb::Fault reason) {
  if (reason == climb::Fault::kNone) return climb_state_t::REASON_NONE;
  return static_cast<std::int8_t>(climb_state_t::REASON_ESTOP + static_cast<int>(reason));
}
static_assert(climb_state_t::REASON_ESTOP + static_cast<int>(climb::Fault::kPerceptionSilent) ==
              climb_state_t::REASON_PERCEPTION_SILENT);
static_assert(static_cast<int>(climb::Fault::kPerceptionSilent) == climb::kNumFaults - 1);

void fill_axes(const CycleReport& report, climb_state_t& m) {
  m.has_targets = report.output.send ? 1 : 0;
  for (int axis = 0; axis < climb::kNumAxes; ++axis) {
    const can::AxisFeedback& heard = report.axes[axis];
    const bool is_heard = std::isfinite(heard.position_rad);
    const double wanted_rad = report.output.axes[axis].position_rad;
    m.wanted_rad[axis] = report.output.send ? static_cast<float>(wanted_rad) : 0.0F;
    m.is_heard[axis] = is_heard ? 1 : 0;
    m.measured_rad[axis] = is_heard ? static_cast<float>(heard.position_rad) : 0.0F;
    m.torque_Nm[axis] = std::isfinite(heard.torque_Nm) ? static_cast<float>(heard.torque_Nm) : 0.0F;
    m.drive_state[axis] = static_cast<std::int8_t>(heard.state);
    m.error_code[axis] = heard.error_code;
  }
}

}  // namespace

climb::OperatorCommand to_command(const command_t& message) {
  return {static_cast<climb::Order>(message.order), static_cast<std::uint64_t>(message.session_id),
          message.seq};
}

void to_message(const CycleReport& report, climb_state_t& m) {
  const climb::ControllerOutput& output = report.output;
  m.state = told(output.state);
  m.reason = told(output.reason);
  m.refusal = told(output.refusal);
  m.burden = told(output.burden);
  m.policy = told(report.policy);
  m.at_top = output.at_top ? 1 : 0;
  m.body_shift = output.body_shift ? 1 : 0;
  m.order = static_cast<std::int8_t>(report.order);
  m.order_seq = report.order_seq;
  m.order_verdict = told(report.verdict);
  m.estop_active = report.lines.estop_clear && !report.lines.lost ? 0 : 1;
  m.lines_lost = report.lines.lost ? 1 : 0;
  for (const climb::Leg leg : climb::kLegs) {
    m.touch[leg] = report.lines.touch[leg] ? 1 : 0;
    m.limb_state[leg] = told(output.limbs[leg]);
    m.rung_id[leg] = output.rung_ids[leg];
  }
  m.bus_phase = told(report.bus_phase);
  fill_axes(report, m);
}

void to_message(const climb::OdometryEstimate& pose, ladder_msgs::pose_t& m) {
  for (int i = 0; i < 3; ++i) m.p_odom_body_m[i] = pose.position_odom_m[i];
  m.q_odom_body[0] = pose.q_odom_body.w();
  m.q_odom_body[1] = pose.q_odom_body.x();
  m.q_odom_body[2] = pose.q_odom_body.y();
  m.q_odom_body[3] = pose.q_odom_body.z();
  m.sigma_position_m = pose.position_sigma_m;
  m.sigma_angle_rad = pose.orientation_sigma_rad;
}

}  // namespace climb_controller
