// SPDX-License-Identifier: BSD-3-Clause
#include "can/odrive_bus.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "base/check.h"

namespace can {
namespace {

using odrive::AxisState;

constexpr double kTwoPi = 6.283185307179586;
constexpr int kMaxFramesPerPoll = 1024;

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
  if (params.axes.empty() || params.axes.size() > 32) return "1..32 axes";
  std::set<int> nodes;
  for (const AxisConfig& axis : params.axes) {
    const std::string problem = check(axis);
    if (!problem.empty()) return "node " + std::to_string(axis.node_id) + ": " + problem;
    if (axis.node_id > odrive::kMaxNode) return "node_id in 1..63";
    if (!nodes.insert(axis.node_id).second) return "node_ids differ";
  }
  if (params.cycle_us < 1000 || params.listen_us < 0 || params.walk_timeout_us <= 0) {
    return "cycle_us >= 1000, listen_us >= 0, walk_timeout_us > 0";
  }
  if (params.drive_lost_ms < 1 || params.max_missed_cycles < 1) {
    return "drive_lost_ms >= 1 and max_missed_cycles >= 1";
  }
  if (params.line.max_stalled_cycles < 1 || params.line.max_malformed_per_s < 1 ||
      params.line.max_malformed_per_s > 31) {
    return "max_stalled_cycles >= 1 and max_malformed_per_s in 1..31";
  }
  if (!(params.torque_constant_Nm_A > 0.0 && std::isfinite(params.torque_constant_Nm_A))) {
    return "torque_constant_Nm_A > 0";
  }
  return "";
}

OdriveBus::OdriveBus(const OdriveParams& params, Transport& transport, FlightRecorder* recorder)
    : params_(params),
      faults_(static_cast<int>(params.axes.size())),
      recorder_(recorder),
      line_(transport, faults_, recorder, params.line) {
  CHECK(check(params).empty(), "the parameters were checked by the caller");
  axis_of_node_.fill(-1);
  axes_.resize(params.axes.size());
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    axes_[i].config = params.axes[i];
    axis_of_node_[params.axes[i].node_id] = static_cast<int>(i);
  }
}

bool OdriveBus::configure() {
  if (phase_ != BusPhase::kIdle && phase_ != BusPhase::kReady) return false;
  after_listening_ = BusPhase::kConfiguring;
  enter(BusPhase::kListening);
  return true;
}

bool OdriveBus::rearm() {
  if (phase_ == BusPhase::kListening || phase_ == BusPhase::kConfiguring) return false;
  after_listening_ = BusPhase::kRearming;
  enter(BusPhase::kListening);
  return true;
}

bool OdriveBus::enable() {
  if (phase_ != BusPhase::kReady && phase_ != BusPhase::kStopped) return false;
  if (faults_.forbids_enabling()) return false;
  enter(BusPhase::kEnabling);
  return true;
}

bool OdriveBus::disable() {
  if (phase_ != BusPhase::kEnabling && phase_ != BusPhase::kEnabled &&
      phase_ != BusPhase::kStopped) {
    return false;
  }
  enter(BusPhase::kDisabling);
  return true;
}

bool OdriveBus::stop(StopKind kind) {
  switch (phase_) {
    case BusPhase::kIdle:
    case BusPhase::kListening:
    case BusPhase::kConfiguring:
    case BusPhase::kFaulted:
      return false;
    default:
      break;
  }
  if (kind == StopKind::kTorqueOff) request(AxisState::kIdle);
  enter(BusPhase::kStopped);
  return true;
}

void OdriveBus::enter(BusPhase phase) {
  phase_ = phase;
  has_phase_begun_ = false;
}

void OdriveBus::request(AxisState state) {
  for (Axis& axis : axes_) {
    axis.wanted = state;
    if (state == AxisState::kIdle) axis.expects_torque = false;
  }
}

void OdriveBus::begin_phase() {
  has_phase_begun_ = true;
  phase_since_us_ = now_us_;
  if (recorder_ != nullptr) recorder_->record(now_us_, phase_);
  switch (phase_) {
    case BusPhase::kListening:
      line_.clear();
      break;
    case BusPhase::kConfiguring:
      is_configured_ = false;
      capabilities_ = {};
      for (Axis& axis : axes_) {
        const double velocity =
            axis.config.max_velocity_rad_s * std::fabs(rev_per_rad(axis.config));
        line_.send(encode(odrive::ControllerMode{axis.config.node_id}));
        const auto limits = encode(odrive::Limits{axis.config.node_id, static_cast<float>(velocity),
                                                  static_cast<float>(axis.config.max_current_A)});
        if (limits) line_.send(*limits);
        axis.has_heartbeat = false;
        axis.has_position = false;
      }
      break;
    case BusPhase::kRearming:
      faults_.clear();  // what the motors said while the bus only listened is about the past
      is_configured_ = false;
      for (Axis& axis : axes_) {
        line_.send(odrive::encode_clear_errors(axis.config.node_id));
        axis.wanted = axis.reported;  // a motor that still holds goes on holding
        axis.expects_torque = false;
        axis.has_heartbeat = false;
        axis.has_position = false;
        axis.num_missed = 0;
        axis.heartbeat_us = now_us_;
      }
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

bool OdriveBus::is_cycling() const {
  return phase_ == BusPhase::kRearming || (is_configured_ && phase_ != BusPhase::kListening);
}

bool OdriveBus::all_heard() const {
  return std::all_of(axes_.begin(), axes_.end(), [](const Axis& axis) {
    return axis.has_heartbeat && axis.has_position && axis.error == 0;
  });
}

bool OdriveBus::all_in(AxisState state) const {
  return std::all_of(axes_.begin(), axes_.end(),
                     [state](const Axis& axis) { return axis.reported == state; });
}

void OdriveBus::advance() {
  const bool is_clearing = phase_ == BusPhase::kListening && !has_phase_begun_;
  if (line_.is_faulted() && phase_ != BusPhase::kFaulted && !is_clearing) {
    enter(BusPhase::kFaulted);
  }
  if (!has_phase_begun_) begin_phase();
  switch (phase_) {
    case BusPhase::kListening:
      if (line_.is_faulted()) return enter(BusPhase::kFaulted);
      if (now_us_ - phase_since_us_ >= params_.listen_us) enter(after_listening_);
      break;
    case BusPhase::kConfiguring:
    case BusPhase::kRearming:
      if (all_heard()) {
        is_configured_ = true;
        capabilities_.absolute_position =
            std::all_of(axes_.begin(), axes_.end(),
                        [](const Axis& axis) { return axis.config.absolute_position; });
        enter(BusPhase::kReady);
      } else if (is_late()) {
        for (int i = 0; i < num_axes(); ++i) {
          const Axis& axis = axes_[static_cast<std::size_t>(i)];
          if (axis.error != 0) line_.raise(FaultCause::kEmergency, i, axis.error);
          if (!axis.has_heartbeat || !axis.has_position) line_.raise(FaultCause::kSilent, i, 0);
        }
        enter(BusPhase::kIdle);
      }
      break;
    case BusPhase::kEnabling:
      if (faults_.forbids_enabling()) return enter(BusPhase::kStopped);
      if (all_in(AxisState::kClosedLoopControl)) {
        for (Axis& axis : axes_) axis.expects_torque = true;
        enter(BusPhase::kEnabled);
      } else if (is_late()) {
        for (int i = 0; i < num_axes(); ++i) {
          const Axis& axis = axes_[static_cast<std::size_t>(i)];
          if (axis.reported != axis.wanted) {
            line_.raise(FaultCause::kEnableTimeout, i, static_cast<std::uint32_t>(axis.reported));
          }
        }
        enter(BusPhase::kStopped);
      }
      break;
    case BusPhase::kDisabling:
      if (all_in(AxisState::kIdle) || is_late()) enter(BusPhase::kReady);
      break;
    default:
      break;
  }
}

void OdriveBus::receive_all() {
  ReceivedFrame received;
  for (int i = 0; i < kMaxFramesPerPoll && line_.receive(received); ++i) {
    const CanFrame& frame = received.frame;
    if (odrive::is_master_frame(frame)) {
      line_.raise(FaultCause::kForeignMaster, -1, frame.id);
      continue;
    }
    const int index = frame.id <= 0x7FF ? axis_of_node_[odrive::node_of(frame.id)] : -1;
    if (index < 0 || !take(axes_[static_cast<std::size_t>(index)], index, frame)) {
      line_.count_malformed();
    }
  }
}

bool OdriveBus::take(Axis& axis, int index, const CanFrame& frame) {
  if (const auto heartbeat = odrive::decode_heartbeat(frame)) {
    axis.has_heartbeat = true;
    axis.heartbeat_us = now_us_;
    axis.error = heartbeat->axis_error;
    axis.reported = static_cast<AxisState>(heartbeat->axis_state);
    if (!is_configured_) return true;
    if (axis.error != 0) line_.raise(FaultCause::kEmergency, index, axis.error);
    if (axis.expects_torque && axis.reported != AxisState::kClosedLoopControl) {
      line_.raise(FaultCause::kLeftOperationEnabled, index, heartbeat->axis_state);
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

void OdriveBus::watch(bool is_cycle) {
  if (!is_configured_) return;
  for (int i = 0; i < num_axes(); ++i) {
    Axis& axis = axes_[static_cast<std::size_t>(i)];
    if (is_cycle) {
      axis.num_missed = axis.is_fresh ? 0 : axis.num_missed + 1;
      axis.was_fresh = axis.is_fresh;
      axis.is_fresh = false;
    }
    if (axis.num_missed >= params_.max_missed_cycles) {
      line_.raise(FaultCause::kSilent, i, static_cast<std::uint32_t>(axis.num_missed));
    }
    const std::int64_t silent_ms = (now_us_ - axis.heartbeat_us) / 1000;
    if (silent_ms > params_.drive_lost_ms) {
      line_.raise(FaultCause::kHeartbeatLost, i, static_cast<std::uint32_t>(silent_ms));
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

void OdriveBus::poll(std::int64_t now_us) {
  now_us_ = now_us;
  line_.begin_poll(now_us);
  receive_all();
  watch(false);
  advance();
}

void OdriveBus::exchange(std::int64_t now_us, const Targets& targets,
                         std::span<AxisFeedback> feedback) {
  CHECK(feedback.size() == axes_.size(), "one feedback per axis");
  now_us_ = now_us;
  line_.begin_poll(now_us);
  const bool may_send = is_cycling() && line_.begin_cycle();
  receive_all();
  watch(true);
  advance();
  fill(feedback);
  if (!may_send || !is_cycling()) return;
  send_cycle(targets);
  line_.end_cycle();
  if (line_.is_faulted()) advance();
}

void OdriveBus::send_cycle(const Targets& targets) {
  if (phase_ == BusPhase::kEnabled && has_phase_begun_) accept_targets(targets);
  for (Axis& axis : axes_) {
    if (!axis.has_position) continue;
    const bool holds = axis.wanted == AxisState::kClosedLoopControl;
    // The target first: a motor that is armed finds it standing where it is.
    if (holds) {
      const auto frame = encode(axis.command);
      if (frame && !line_.send(*frame)) return;
    }
    const bool may_request = axis.wanted == AxisState::kIdle ? phase_ != BusPhase::kReady
                                                             : phase_ == BusPhase::kEnabling;
    if (axis.wanted != axis.reported && axis.error == 0 && may_request) {
      if (!line_.send(encode(odrive::SetAxisState{axis.config.node_id, axis.wanted}))) return;
    }
  }
}

void OdriveBus::accept_targets(const Targets& targets) {
  CHECK(targets.axes.size() == axes_.size(), "one target per axis while enabled");
  const std::int64_t age_us = now_us_ - targets.time_us;
  if (!(age_us >= 0 && age_us <= 2 * params_.cycle_us)) {
    line_.raise(FaultCause::kTargetRefused, -1, 0);
    return;
  }
  bool all_sound = true;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    if (offer(axes_[i], targets.axes[i])) continue;
    line_.raise(FaultCause::kTargetRefused, static_cast<int>(i), 0);
    all_sound = false;
  }
  if (!all_sound) return;
  for (Axis& axis : axes_) {
    if (axis.wanted == AxisState::kClosedLoopControl) axis.command = axis.offered;
  }
}

bool OdriveBus::offer(Axis& axis, const AxisTarget& target) const {
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

}  // namespace can
