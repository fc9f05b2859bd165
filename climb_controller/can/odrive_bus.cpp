// SPDX-License-Identifier: BSD-3-Clause
#include "can/odrive_bus.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"

namespace can {
namespace {

using odrive::AxisState;

constexpr double kTwoPi = 6.283185307179586;

double rev_per_rad(const AxisConfig& axis) {
  return axis.gear / kTwoPi * axis.sign;
}

/// value * 1000, nearest; none when it does not fit 16 bits (NaN included).
std::optional<std::int16_t> milli(double value) {
  const double scaled = std::floor(value * 1000.0 + 0.5);
  if (!(scaled >= -32768.0 && scaled <= 32767.0)) return std::nullopt;
  return static_cast<std::int16_t>(scaled);
}

}  // namespace

std::string check(const OdriveParams& params) {
  const std::string problem = check_bus(params);
  if (!problem.empty()) return problem;
  for (const AxisConfig& axis : params.axes) {
    if (axis.node_id > odrive::kMaxNode) return "node_id in 1..63";
  }
  if (!(params.torque_constant_Nm_A > 0.0 && std::isfinite(params.torque_constant_Nm_A))) {
    return "torque_constant_Nm_A > 0";
  }
  return "";
}

OdriveBus::OdriveBus(const OdriveParams& params, Transport& transport, FlightRecorder* recorder)
    : PhasedBus(params, transport, recorder), params_(params) {
  CHECK(check(params).empty(), "the parameters were checked by the caller");
  axis_of_node_.fill(-1);
  axes_.resize(params.axes.size());
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    axes_[i].config = params.axes[i];
    axis_of_node_[params.axes[i].node_id] = static_cast<int>(i);
  }
}

void OdriveBus::begin_stop(StopKind kind) {
  if (kind == StopKind::kTorqueOff) request(AxisState::kIdle);
}

void OdriveBus::request(AxisState state) {
  for (Axis& axis : axes_) {
    axis.wanted = state;
    if (state == AxisState::kIdle) axis.expects_torque = false;
  }
}

void OdriveBus::begin_phase() {
  switch (phase()) {
    case BusPhase::kConfiguring:
      configure_axes();
      break;
    case BusPhase::kRearming:
      forget_axes();
      break;
    case BusPhase::kEnabling:
      request(AxisState::kClosedLoopControl);
      break;
    case BusPhase::kDisabling:
      request(AxisState::kIdle);
      break;
    default:
      break;
  }
}

void OdriveBus::configure_axes() {
  is_configured_ = false;
  claims() = {};
  for (Axis& axis : axes_) {
    const double velocity = axis.config.max_velocity_rad_s * std::fabs(rev_per_rad(axis.config));
    line().send(encode(odrive::ControllerMode{axis.config.node_id}));
    const auto limits = encode(odrive::Limits{axis.config.node_id, static_cast<float>(velocity),
                                              static_cast<float>(axis.config.max_current_A)});
    if (limits) line().send(*limits);
    axis.has_heartbeat = false;
    axis.has_position = false;
  }
}

void OdriveBus::forget_axes() {
  fault_log().clear();  // what the motors said while the bus only listened is about the past
  is_configured_ = false;
  for (Axis& axis : axes_) {
    line().send(odrive::encode_clear_errors(axis.config.node_id));
    axis.wanted = axis.reported;  // a motor that still holds goes on holding
    axis.expects_torque = false;
    axis.has_heartbeat = false;
    axis.has_position = false;
    axis.num_missed = 0;
    axis.heartbeat_us = now_us();
  }
}

bool OdriveBus::is_cycling() const {
  return phase() == BusPhase::kRearming || (is_configured_ && phase() != BusPhase::kListening);
}

bool OdriveBus::all_heard() const {
  return std::all_of(axes_.begin(), axes_.end(), [](const Axis& axis) {
    return axis.has_heartbeat && axis.has_position && axis.error == 0;
  });
}

bool OdriveBus::all_in(AxisState state) const {
  return std::all_of(axes_.begin(), axes_.end(), [state](const Axis& axis) {
    return axis.reported == state && !axis.is_doubted;
  });
}

void OdriveBus::advance_phase() {
  switch (phase()) {
    case BusPhase::kConfiguring:
    case BusPhase::kRearming:
      advance_listening_to_axes();
      break;
    case BusPhase::kEnabling:
      advance_enabling();
      break;
    case BusPhase::kDisabling:
      if (all_in(AxisState::kIdle) || is_late()) enter(BusPhase::kReady);
      break;
    default:
      break;
  }
}

void OdriveBus::advance_listening_to_axes() {
  if (all_heard()) {
    is_configured_ = true;
    claims().absolute_position = std::all_of(
        axes_.begin(), axes_.end(), [](const Axis& axis) { return axis.config.absolute_position; });
    return enter(BusPhase::kReady);
  }
  if (!is_late()) return;
  for (int i = 0; i < num_axes(); ++i) {
    const Axis& axis = axes_[static_cast<std::size_t>(i)];
    if (axis.error != 0) line().raise(FaultCause::kEmergency, i, axis.error);
    if (!axis.has_heartbeat || !axis.has_position) line().raise(FaultCause::kSilent, i, 0);
  }
  enter(BusPhase::kIdle);
}

void OdriveBus::advance_enabling() {
  if (fault_log().forbids_enabling()) return enter(BusPhase::kStopped);
  if (all_in(AxisState::kClosedLoopControl)) {
    for (Axis& axis : axes_) axis.expects_torque = true;
    return enter(BusPhase::kEnabled);
  }
  if (!is_late()) return;
  for (int i = 0; i < num_axes(); ++i) {
    const Axis& axis = axes_[static_cast<std::size_t>(i)];
    if (axis.reported == axis.wanted) continue;
    line().raise(FaultCause::kEnableTimeout, i, static_cast<std::uint32_t>(axis.reported));
  }
  enter(BusPhase::kStopped);
}

void OdriveBus::take(const ReceivedFrame& received) {
  const CanFrame& frame = received.frame;
  if (odrive::is_master_frame(frame)) {
    line().raise(FaultCause::kForeignMaster, -1, frame.id);
    return;
  }
  const int index = frame.id <= 0x7FF ? axis_of_node_[odrive::node_of(frame.id)] : -1;
  if (index < 0 || !take(axes_[static_cast<std::size_t>(index)], index, frame)) {
    line().count_malformed();
  }
}

bool OdriveBus::take(Axis& axis, int index, const CanFrame& frame) {
  if (const auto heartbeat = odrive::decode_heartbeat(frame)) {
    axis.has_heartbeat = true;
    axis.is_doubted = false;
    axis.heartbeat_us = now_us();
    axis.error = heartbeat->axis_error;
    axis.reported = static_cast<AxisState>(heartbeat->axis_state);
    if (!is_configured_) return true;
    if (axis.error != 0) line().raise(FaultCause::kEmergency, index, axis.error);
    if (axis.expects_torque && axis.reported != AxisState::kClosedLoopControl) {
      line().raise(FaultCause::kLeftOperationEnabled, index, heartbeat->axis_state);
      axis.wanted = axis.reported;  // never enabled again by itself
    }
    return true;
  }
  if (const auto estimates = odrive::decode_encoder_estimates(frame)) {
    axis.position_rev = estimates->position_rev;
    const bool follows = axis.reported == AxisState::kClosedLoopControl && axis.has_position;
    if (!follows) axis.command = {axis.config.node_id, axis.position_rev, 0, 0};
    axis.has_position = true;
    axis.is_fresh = true;
    return true;
  }
  if (const auto iq = odrive::decode_iq(frame)) {
    axis.current_A = iq->measured_A;
    axis.has_current = true;
    return true;
  }
  return false;
}

void OdriveBus::watch_cycle() {
  if (!is_configured_) return;
  for (Axis& axis : axes_) {
    axis.num_missed = axis.is_fresh ? 0 : axis.num_missed + 1;
    axis.was_fresh = axis.is_fresh;
    axis.is_fresh = false;
  }
}

void OdriveBus::watch_time() {
  if (!is_configured_) return;
  for (int i = 0; i < num_axes(); ++i) {
    const Axis& axis = axes_[static_cast<std::size_t>(i)];
    if (axis.num_missed >= params_.max_missed_cycles) {
      line().raise(FaultCause::kSilent, i, static_cast<std::uint32_t>(axis.num_missed));
    }
    const std::int64_t silent_ms = (now_us() - axis.heartbeat_us) / 1000;
    if (silent_ms > params_.drive_lost_ms) {
      line().raise(FaultCause::kHeartbeatLost, i, static_cast<std::uint32_t>(silent_ms));
    }
  }
}

void OdriveBus::fill(std::span<AxisFeedback> feedback) const {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const Axis& axis = axes_[i];
    const AxisConfig& config = axis.config;
    AxisFeedback& out = feedback[i];
    out = {};
    if (axis.has_heartbeat) {
      out.state = axis.error != 0                                  ? DriveState::kFault
                  : axis.reported == AxisState::kClosedLoopControl ? DriveState::kOperationEnabled
                                                                   : DriveState::kSwitchOnDisabled;
    }
    out.fresh = axis.was_fresh;
    out.missed_cycles = axis.num_missed;
    out.error_code = static_cast<std::uint16_t>(axis.error);
    out.position_rad =
        axis.has_position ? axis.position_rev / rev_per_rad(config) + config.offset_rad : kNone;
    out.torque_Nm = axis.has_current
                        ? axis.current_A * params_.torque_constant_Nm_A * config.gear * config.sign
                        : kNone;
  }
}

void OdriveBus::send_cycle(const Targets& targets) {
  const bool was_away = now_us() - cycle_us_ > params_.max_missed_cycles * params_.cycle_us;
  cycle_us_ = now_us();
  // After a pause motors may have disarmed themselves, and the limb may have moved. Until each has
  // said its state anew it gets only the target it had, which feeds the watchdog of one that holds,
  // and is not armed.
  if (was_away) {
    for (Axis& axis : axes_) axis.is_doubted = true;
  }
  take_targets(targets);
  for (Axis& axis : axes_) {
    if (!axis.has_position) continue;
    const bool holds = axis.wanted == AxisState::kClosedLoopControl;
    // The target first: a motor that is armed finds it standing where it is.
    if (holds) {
      const auto frame = encode(axis.command);
      if (frame && !line().send(*frame)) return;
    }
    const bool may_request = axis.wanted == AxisState::kIdle ? phase() != BusPhase::kReady
                                                             : phase() == BusPhase::kEnabling;
    const bool is_sound = axis.error == 0 && !axis.is_doubted;
    if (axis.wanted != axis.reported && is_sound && may_request) {
      if (!line().send(encode(odrive::SetAxisState{axis.config.node_id, axis.wanted}))) return;
    }
  }
}

bool OdriveBus::offer_target(int index, const AxisTarget& target) {
  Axis& axis = axes_[static_cast<std::size_t>(index)];
  const AxisConfig& config = axis.config;
  const auto position =
      static_cast<float>((target.position_rad - config.offset_rad) * rev_per_rad(config));
  const auto velocity = milli(target.velocity_rad_s * rev_per_rad(config));
  const auto torque = milli(target.torque_Nm / config.gear * config.sign);
  if (!std::isfinite(position) || !velocity || !torque || !(target.max_torque_Nm >= 0.0)) {
    return false;
  }
  axis.offered = {config.node_id, position, *velocity, *torque};
  return true;
}

void OdriveBus::accept_offered() {
  for (Axis& axis : axes_) {
    const bool follows = axis.wanted == AxisState::kClosedLoopControl && !axis.is_doubted;
    if (follows) axis.command = axis.offered;
  }
}

}  // namespace can
