// SPDX-License-Identifier: BSD-3-Clause
#include "tof/head_schedule.h"

#include <algorithm>

#include "base/check.h"

namespace tof {
namespace {

constexpr double kShortestPeriod_us = 5e3;
constexpr double kLongestPeriod_us = 1e6;
constexpr std::int64_t kLargestGap = 1000000;  ///< a larger one is a corrupt number
constexpr double kPeriodGain = 0.125;          ///< smooths jitter over about eight frames

}  // namespace

HeadSchedule::HeadSchedule(const HeadParams& params) : params_(params) {
  reset();
}

Arrival HeadSchedule::arrive(int head_index, std::int64_t utime_us, std::int64_t seq) {
  CHECK(head_index >= 0 && head_index < kNumHeads, "the frame was checked before");
  Head& head = heads_[head_index];
  const bool was_seen = head.state != HeadState::kUnknown;
  if (was_seen && seq == head.seq) {
    ++head.counters.duplicate;
    return Arrival::kDuplicate;
  }
  if ((was_seen && utime_us <= head.utime_us) || is_silence(head, newest_utime_us_ - utime_us)) {
    ++head.counters.late;
    return Arrival::kLate;
  }
  if (was_seen && seq > head.seq) {
    head.counters.lost += std::min(seq - head.seq - 1, kLargestGap);
    measure_period(head, utime_us, seq);
  }
  ++head.counters.accepted;
  head.state = HeadState::kLive;
  head.utime_us = utime_us;
  head.seq = seq;
  newest_utime_us_ = std::max(newest_utime_us_, utime_us);
  bury_silent_heads();
  return Arrival::kAccepted;
}

bool HeadSchedule::is_silence(const Head& head, std::int64_t age_us) const {
  return static_cast<double>(age_us) > params_.dead_periods * head.period_us;
}

void HeadSchedule::measure_period(Head& head, std::int64_t utime_us, std::int64_t seq) const {
  const double interval_us =
      static_cast<double>(utime_us - head.utime_us) / static_cast<double>(seq - head.seq);
  const double bounded_us = std::clamp(interval_us, kShortestPeriod_us, kLongestPeriod_us);
  // A silence that killed the head says nothing about its rhythm.
  if (head.state == HeadState::kDead) return;
  head.period_us += kPeriodGain * (bounded_us - head.period_us);
}

void HeadSchedule::bury_silent_heads() {
  for (Head& head : heads_) {
    if (head.state != HeadState::kLive) continue;
    if (!is_silence(head, newest_utime_us_ - head.utime_us)) continue;
    head.state = HeadState::kDead;
    head.counters.expired += head.is_waiting;
    head.is_waiting = false;
  }
}

bool HeadSchedule::is_complete() const {
  bool is_any = false;
  for (int h = 0; h < kNumHeads; ++h) {
    const Head& head = heads_[h];
    const bool is_awaited =
        head.state == HeadState::kLive ||
        (head.state == HeadState::kUnknown && !had_cloud_ && h < params_.awaited_at_start);
    if (is_awaited && !head.is_waiting) return false;
    is_any |= head.is_waiting;
  }
  return is_any;
}

void HeadSchedule::take_all() {
  for (Head& head : heads_) head.is_waiting = false;
  had_cloud_ = true;
}

void HeadSchedule::reset() {
  for (Head& head : heads_) {
    const HeadCounters counters = head.counters;
    head = Head{};
    head.counters = counters;
    head.period_us = params_.period_s * 1e6;
  }
  newest_utime_us_ = 0;
  had_cloud_ = false;
}

}  // namespace tof
