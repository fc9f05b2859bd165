// SPDX-License-Identifier: BSD-3-Clause
// What is heard, watched and sent; the phases advance in cia402_phases.cpp.
#include "can/cia402_bus.h"

#include <algorithm>

#include "base/check.h"

namespace can {

using cia402::Goal;

namespace {
constexpr std::uint32_t kFromThisHost = 0x80000000;
}  // namespace

Cia402Bus::Cia402Bus(const Cia402Params& params, Transport& transport, FlightRecorder* recorder)
    : PhasedBus(params, transport, recorder), params_(params) {
  CHECK(check(params).empty(), "the parameters were checked by the caller");
  axis_of_node_.fill(-1);
  axes_.reserve(params.axes.size());
  for (const AxisConfig& axis : params.axes) {
    axis_of_node_[axis.node_id] = num_axes();
    axes_.emplace_back(num_axes(), axis, params_);
  }
}

void Cia402Bus::begin_stop(StopKind kind) {
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
}

void Cia402Bus::set_goal(Goal goal) {
  for (Cia402Axis& axis : axes_) axis.set_goal(goal);
}

bool Cia402Bus::is_known(std::uint8_t node) const {
  const auto& others = params_.other_nodes;
  return std::find(others.begin(), others.end(), node) != others.end();
}

void Cia402Bus::take(const ReceivedFrame& received) {
  const CanFrame& frame = received.frame;
  if (cia402::is_master_frame(frame)) {
    line().raise(FaultCause::kForeignMaster, -1,
                 frame.id | (received.from_this_host ? kFromThisHost : 0));
    return;
  }
  const std::uint8_t node = cia402::node_of(frame.id);
  const int axis = axis_of_node_[node];
  const bool is_sound = axis >= 0
                            ? axes_[static_cast<std::size_t>(axis)].take(frame, line(), now_us())
                            : is_known(node);
  if (!is_sound) line().count_malformed();
}

void Cia402Bus::watch_cycle() {
  for (Cia402Axis& axis : axes_) axis.watch_cycle(line(), was_sync_sent_);
  was_sync_sent_ = false;
}

void Cia402Bus::watch_time() {
  if (!is_speaking_) return;
  for (Cia402Axis& axis : axes_) axis.watch_time(line(), params_, now_us());
}

void Cia402Bus::fill(std::span<AxisFeedback> feedback) const {
  for (std::size_t i = 0; i < axes_.size(); ++i) axes_[i].fill(feedback[i]);
}

void Cia402Bus::send_cycle(const Targets& targets) {
  send_heartbeat_if_older(params_.master_heartbeat_us - params_.cycle_us / 2);
  const bool was_away = now_us() - cycle_us_ > params_.max_missed_cycles * params_.cycle_us;
  cycle_us_ = now_us();
  // After a pause the drives may have stopped by themselves; an enabling word from before would
  // silently undo that. So first only SYNC, until each has said its state anew.
  if (was_away) {
    for (Cia402Axis& axis : axes_) axis.doubt();
  }
  send_commands(targets);
}

void Cia402Bus::send_commands(const Targets& targets) {
  take_targets(targets);
  for (Cia402Axis& axis : axes_) {
    if (!axis.may_send()) continue;
    if (!line().send(encode(axis.next_rpdo1()))) return;  // what follows would not fit either
    if (params_.feed_forward && !line().send(encode(axis.next_rpdo2()))) return;
  }
  was_sync_sent_ = line().send(cia402::encode_sync());
}

bool Cia402Bus::offer_target(int axis, const AxisTarget& target) {
  return axes_[static_cast<std::size_t>(axis)].offer_target(target);
}

void Cia402Bus::accept_offered() {
  for (Cia402Axis& axis : axes_) axis.accept_target();
}

void Cia402Bus::send_heartbeat_if_older(std::int64_t age_us) {
  if (!is_speaking_ || now_us() - heartbeat_us_ < age_us) return;
  if (line().send(encode(cia402::Heartbeat{cia402::kMasterNode, cia402::NmtState::kOperational}))) {
    heartbeat_us_ = now_us();
  }
}

void Cia402Bus::send_to_all(cia402::NmtCommand command) {
  for (const Cia402Axis& axis : axes_) line().send(encode(cia402::Nmt{command, axis.node()}));
}

}  // namespace can
