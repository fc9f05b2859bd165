// SPDX-License-Identifier: BSD-3-Clause
// Requests and cycles; the phases advance in cia402_phases.cpp.
#include "can/cia402_bus.h"

#include <algorithm>

#include "base/check.h"

namespace can {

using cia402::Goal;

namespace {
constexpr int kMaxFramesPerPoll = 1024;  // more than a full bus carries in 100 ms
constexpr std::uint32_t kFromThisHost = 0x80000000;
}  // namespace

Cia402Bus::Cia402Bus(const Cia402Params& params, Transport& transport, FlightRecorder* recorder)
    : params_(params),
      faults_(static_cast<int>(params.axes.size())),
      recorder_(recorder),
      line_(transport, faults_, recorder, params.line) {
  CHECK(check(params).empty(), "the parameters were checked by the caller");
  axis_of_node_.fill(-1);
  axes_.reserve(params.axes.size());
  for (const AxisConfig& axis : params.axes) {
    axis_of_node_[axis.node_id] = num_axes();
    axes_.emplace_back(num_axes(), axis, params_);
  }
}

bool Cia402Bus::configure() {
  if (phase_ != BusPhase::kIdle && phase_ != BusPhase::kReady) return false;
  after_listening_ = BusPhase::kConfiguring;
  enter(BusPhase::kListening);
  return true;
}

bool Cia402Bus::rearm() {
  if (phase_ == BusPhase::kListening || phase_ == BusPhase::kConfiguring) return false;
  after_listening_ = BusPhase::kRearming;
  enter(BusPhase::kListening);
  return true;
}

bool Cia402Bus::enable() {
  if (phase_ != BusPhase::kReady && phase_ != BusPhase::kStopped) return false;
  if (faults_.forbids_enabling()) return false;
  enter(BusPhase::kEnabling);
  return true;
}

bool Cia402Bus::disable() {
  if (phase_ != BusPhase::kEnabling && phase_ != BusPhase::kEnabled &&
      phase_ != BusPhase::kStopped) {
    return false;
  }
  enter(BusPhase::kDisabling);
  return true;
}

bool Cia402Bus::stop(StopKind kind) {
  switch (phase_) {
    case BusPhase::kIdle:
    case BusPhase::kListening:
    case BusPhase::kConfiguring:
    case BusPhase::kFaulted:
      return false;
    default:
      break;
  }
  switch (kind) {
    case StopKind::kHold:
      set_goal(Goal::kKeep);
      break;
    case StopKind::kQuickStop:
      set_goal(Goal::kQuickStop);
      break;
    case StopKind::kTorqueOff:
      set_goal(Goal::kNoTorque);
      break;
  }
  for (Cia402Axis& axis : axes_) axis.set_fault_reset(false);
  enter(BusPhase::kStopped);
  return true;
}

void Cia402Bus::set_goal(Goal goal) {
  for (Cia402Axis& axis : axes_) axis.set_goal(goal);
}

void Cia402Bus::poll(std::int64_t now_us) {
  now_us_ = now_us;
  line_.begin_poll(now_us);
  receive_all();
  watch_time();
  advance();
  send_heartbeat_if_older(params_.master_heartbeat_us);
}

void Cia402Bus::exchange(std::int64_t now_us, const Targets& targets,
                         std::span<AxisFeedback> feedback) {
  CHECK(feedback.size() == axes_.size(), "one feedback per axis");
  now_us_ = now_us;
  line_.begin_poll(now_us);
  // Before anything of this cycle is handed over: has the last cycle left?
  const bool may_send = is_cycling() && line_.begin_cycle();
  receive_all();
  for (Cia402Axis& axis : axes_) axis.watch_cycle(line_, was_sync_sent_);
  was_sync_sent_ = false;
  watch_time();
  advance();
  for (std::size_t i = 0; i < axes_.size(); ++i) axes_[i].fill(feedback[i]);
  if (!may_send || !is_cycling()) {
    send_heartbeat_if_older(params_.master_heartbeat_us);
    return;
  }
  send_heartbeat_if_older(params_.master_heartbeat_us - params_.cycle_us / 2);
  const bool was_away = now_us_ - cycle_us_ > params_.max_missed_cycles * params_.cycle_us;
  cycle_us_ = now_us_;
  // After a pause the drives may have stopped by themselves; an enabling word from before would
  // silently undo that. So first only SYNC: what they say now decides.
  if (was_away) {
    was_sync_sent_ = line_.send(cia402::encode_sync());
  } else {
    send_cycle(targets);
  }
  line_.end_cycle();
  if (line_.is_faulted()) advance();
}

void Cia402Bus::receive_all() {
  ReceivedFrame received;
  for (int i = 0; i < kMaxFramesPerPoll && line_.receive(received); ++i) take(received);
}

bool Cia402Bus::is_known(std::uint8_t node) const {
  const auto& others = params_.other_nodes;
  return std::find(others.begin(), others.end(), node) != others.end();
}

void Cia402Bus::take(const ReceivedFrame& received) {
  const CanFrame& frame = received.frame;
  if (cia402::is_master_frame(frame)) {
    line_.raise(FaultCause::kForeignMaster, -1,
                frame.id | (received.from_this_host ? kFromThisHost : 0));
    return;
  }
  const std::uint8_t node = cia402::node_of(frame.id);
  const int axis = axis_of_node_[node];
  const bool is_sound = axis >= 0
                            ? axes_[static_cast<std::size_t>(axis)].take(frame, line_, now_us_)
                            : is_known(node);
  if (!is_sound) line_.count_malformed();
}

void Cia402Bus::watch_time() {
  if (!is_speaking_) return;
  for (Cia402Axis& axis : axes_) axis.watch_time(line_, params_, now_us_);
}

void Cia402Bus::send_cycle(const Targets& targets) {
  if (phase_ == BusPhase::kEnabled && has_phase_begun_) accept_targets(targets);
  for (Cia402Axis& axis : axes_) {
    if (!axis.may_send()) continue;
    if (!line_.send(encode(axis.next_rpdo1()))) return;  // what follows would not fit either
    if (params_.feed_forward && !line_.send(encode(axis.next_rpdo2()))) return;
  }
  was_sync_sent_ = line_.send(cia402::encode_sync());
}

void Cia402Bus::accept_targets(const Targets& targets) {
  CHECK(targets.axes.size() == axes_.size(), "one target per axis while enabled");
  const std::int64_t age_us = now_us_ - targets.time_us;
  if (!(age_us >= 0 && age_us <= 2 * params_.cycle_us)) {
    line_.raise(FaultCause::kTargetRefused, -1, 0);
    return;
  }
  bool all_sound = true;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    if (axes_[i].offer_target(targets.axes[i])) continue;
    line_.raise(FaultCause::kTargetRefused, static_cast<int>(i), 0);
    all_sound = false;
  }
  if (!all_sound) return;  // all or none: the limbs stay together
  for (Cia402Axis& axis : axes_) axis.accept_target();
}

void Cia402Bus::send_heartbeat_if_older(std::int64_t age_us) {
  if (!is_speaking_ || now_us_ - heartbeat_us_ < age_us) return;
  if (line_.send(encode(cia402::Heartbeat{cia402::kMasterNode, cia402::NmtState::kOperational}))) {
    heartbeat_us_ = now_us_;
  }
}

void Cia402Bus::send_to_all(cia402::NmtCommand command) {
  for (const Cia402Axis& axis : axes_) line_.send(encode(cia402::Nmt{command, axis.node()}));
}

}  // namespace can
