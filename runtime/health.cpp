// SPDX-License-Identifier: BSD-3-Clause
#include "runtime/health.h"

#include <algorithm>
#include <limits>

#include <unistd.h>

#include "runtime/clock.h"

namespace runtime {
namespace {

std::int32_t bounded(std::int64_t value) {
  return static_cast<std::int32_t>(
      std::clamp<std::int64_t>(value, -1, std::numeric_limits<std::int32_t>::max()));
}

}  // namespace

Health::Health(std::int8_t service) {
  message_.service = service;
  message_.state = ladder_msgs::health_t::STATE_WAITING;
  message_.pid = getpid();
  message_.start_utime = clock_now().utime_us;
  message_.seq = -1;
}

void Health::set_head_state(const std::array<std::int8_t, 4>& state) {
  std::copy(state.begin(), state.end(), message_.head_state);
}

void Health::add_stage_us(std::size_t stage, std::int64_t duration_us) {
  if (stages_.size() <= stage) stages_.resize(stage + 1);
  stages_[stage].add(duration_us);
}

const ladder_msgs::health_t& Health::snapshot(std::int64_t utime_us, const Bus& bus) {
  ladder_msgs::health_t& m = message_;
  m.utime = utime_us;
  ++m.seq;
  set_flag(ladder_msgs::health_t::FLAG_PUBLISH_FAILED, bus.publish_failures() > 0);

  m.num_inputs = static_cast<std::int32_t>(bus.inputs().size());
  m.input_channel.clear();
  m.input_received.clear();
  m.input_lost.clear();
  m.input_overwritten.clear();
  m.input_rejected.clear();
  m.input_age_p50_us.clear();
  m.input_age_p99_us.clear();
  for (const auto& input : bus.inputs()) {
    m.input_channel.push_back(input->channel_number);
    m.input_received.push_back(input->counts.received);
    m.input_lost.push_back(input->counts.lost);
    m.input_overwritten.push_back(input->counts.overwritten);
    m.input_rejected.push_back(input->counts.rejected);
    m.input_age_p50_us.push_back(bounded(input->counts.age_us.quantile(0.5)));
    m.input_age_p99_us.push_back(bounded(input->counts.age_us.quantile(0.99)));
  }
  m.rejected_size = bus.rejected(Reject::kSize);
  m.rejected_fingerprint = bus.rejected(Reject::kFingerprint);
  m.rejected_count = bus.rejected(Reject::kCount);
  m.rejected_string = bus.rejected(Reject::kString);
  m.rejected_trailing = bus.rejected(Reject::kTrailing);
  m.rejected_depth = bus.rejected(Reject::kDepth);
  m.rejected_value = bus.rejected(Reject::kValue);
  m.rejected_stale = bus.rejected(Reject::kStale);

  m.num_stages = static_cast<std::int32_t>(stages_.size());
  m.stage_p50_us.clear();
  m.stage_p95_us.clear();
  m.stage_max_us.clear();
  for (const base::Quantiles& stage : stages_) {
    m.stage_p50_us.push_back(bounded(stage.quantile(0.5)));
    m.stage_p95_us.push_back(bounded(stage.quantile(0.95)));
    m.stage_max_us.push_back(bounded(stage.quantile(1.0)));
  }
  return m;
}

StageTimer::StageTimer(Health& health, std::size_t stage)
    : health_(health), stage_(stage), start_us_(clock_now().monotonic_us) {}

StageTimer::~StageTimer() {
  health_.add_stage_us(stage_, clock_now().monotonic_us - start_us_);
}

}  // namespace runtime
