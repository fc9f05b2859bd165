// SPDX-License-Identifier: BSD-3-Clause
#include "can/phased_bus.h"

#include <set>
#include <utility>

#include "base/check.h"

namespace can {

namespace {
constexpr int kMaxFramesPerPoll = 1024;  // more than a full bus carries in 100 ms
}  // namespace

std::string check_bus(const BusParams& params) {
  if (params.axes.empty() || params.axes.size() > 32) return "1..32 axes";
  std::set<int> nodes;
  for (const AxisConfig& axis : params.axes) {
    const std::string problem = check(axis);
    if (!problem.empty()) return "node " + std::to_string(axis.node_id) + ": " + problem;
    if (!nodes.insert(axis.node_id).second) {
      return "node_id " + std::to_string(axis.node_id) + " occurs twice";
    }
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
  return "";
}

PhasedBus::PhasedBus(const BusParams& params, Transport& transport, FlightRecorder* recorder)
    : cycle_us_(params.cycle_us),
      listen_us_(params.listen_us),
      walk_timeout_us_(params.walk_timeout_us),
      max_unsent_us_(params.line.max_stalled_cycles * params.cycle_us),
      faults_(static_cast<int>(params.axes.size())),
      recorder_(recorder),
      line_(transport, faults_, recorder, params.line) {}

bool PhasedBus::configure() {
  if (phase_ != BusPhase::kIdle && phase_ != BusPhase::kReady) return false;
  after_listening_ = BusPhase::kConfiguring;
  enter(BusPhase::kListening);
  return true;
}

bool PhasedBus::rearm() {
  if (phase_ == BusPhase::kListening || phase_ == BusPhase::kConfiguring) return false;
  after_listening_ = BusPhase::kRearming;
  enter(BusPhase::kListening);
  return true;
}

bool PhasedBus::enable() {
  if (phase_ != BusPhase::kReady && phase_ != BusPhase::kStopped) return false;
  if (faults_.forbids_enabling()) return false;
  enter(BusPhase::kEnabling);
  return true;
}

bool PhasedBus::disable() {
  if (phase_ != BusPhase::kEnabling && phase_ != BusPhase::kEnabled &&
      phase_ != BusPhase::kStopped) {
    return false;
  }
  enter(BusPhase::kDisabling);
  return true;
}

bool PhasedBus::stop(StopKind kind) {
  switch (phase_) {
    case BusPhase::kIdle:
    case BusPhase::kListening:
    case BusPhase::kConfiguring:
    case BusPhase::kFaulted:
      return false;
    default:
      break;
  }
  begin_stop(kind);
  enter(BusPhase::kStopped);
  return true;
}

void PhasedBus::enter(BusPhase phase) {
  phase_ = phase;
  has_phase_begun_ = false;  // begins at the next poll, which knows the time
}

bool PhasedBus::is_late() const {
  return now_us_ - phase_since_us_ > walk_timeout_us_;
}

void PhasedBus::poll(std::int64_t now_us) {
  now_us_ = now_us;
  line_.begin_poll(now_us);
  line_.watch_unsent(max_unsent_us_);
  receive_all();
  watch_time();
  advance();
  keep_alive();
}

void PhasedBus::begin_cycle(std::int64_t now_us, std::span<AxisFeedback> feedback) {
  CHECK(static_cast<int>(feedback.size()) == num_axes(), "one feedback per axis");
  now_us_ = now_us;
  line_.begin_poll(now_us);
  // Before anything of this cycle is handed over: has the last cycle left?
  may_send_ = is_cycling() && line_.begin_cycle();
  receive_all();
  watch_cycle();
  watch_time();
  advance();
  fill(feedback);
}

void PhasedBus::end_cycle(const Targets& targets) {
  const bool may_send = std::exchange(may_send_, false);
  if (!may_send || !is_cycling()) return keep_alive();
  send_cycle(targets);
  line_.end_cycle();
  if (line_.is_faulted()) advance();
}

void PhasedBus::receive_all() {
  ReceivedFrame received;
  for (int i = 0; i < kMaxFramesPerPoll && line_.receive(received); ++i) take(received);
}

void PhasedBus::begin() {
  has_phase_begun_ = true;
  phase_since_us_ = now_us_;
  if (recorder_ != nullptr) recorder_->record(now_us_, phase_);
  if (phase_ == BusPhase::kListening) {
    line_.clear();
  } else {
    begin_phase();
  }
}

void PhasedBus::advance() {
  const bool is_clearing = phase_ == BusPhase::kListening && !has_phase_begun_;
  if (line_.is_faulted() && phase_ != BusPhase::kFaulted && !is_clearing) {
    enter(BusPhase::kFaulted);
  }
  if (!has_phase_begun_) begin();
  if (phase_ != BusPhase::kListening) return advance_phase();
  if (line_.is_faulted()) return enter(BusPhase::kFaulted);
  if (!skips_listening() && now_us_ - phase_since_us_ < listen_us_) return;
  enter(after_listening_);
  begin();
}

void PhasedBus::take_targets(const Targets& targets) {
  if (phase_ != BusPhase::kEnabled || !has_phase_begun_) return;
  CHECK(static_cast<int>(targets.axes.size()) == num_axes(), "one target per axis while enabled");
  const std::int64_t age_us = now_us_ - targets.time_us;
  if (!(age_us >= 0 && age_us <= 2 * cycle_us_)) {
    line_.raise(FaultCause::kTargetRefused, -1, 0);
    return;
  }
  bool all_sound = true;
  for (int i = 0; i < num_axes(); ++i) {
    if (offer_target(i, targets.axes[static_cast<std::size_t>(i)])) continue;
    line_.raise(FaultCause::kTargetRefused, i, 0);
    all_sound = false;
  }
  if (all_sound) accept_offered();  // all or none: the limbs stay together
}

}  // namespace can
