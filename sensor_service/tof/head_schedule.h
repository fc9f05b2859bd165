// SPDX-License-Identifier: BSD-3-Clause
// When a cloud is due: the emission rule, on times and sequence numbers alone.
// A cloud is due when every live head has delivered once since the last cloud, or when a head
// delivers its second frame (that frame then opens the next cloud, so every frame enters exactly
// one). Before the first cloud those awaited at the start count as live: head 0 defines x of odom,
// and what learns from clouds begins with all there is in view.
#pragma once

#include <array>
#include <cstdint>

#include "tof/depth_frame.h"
#include "tof/params.h"

namespace tof {

enum class HeadState : std::uint8_t { kUnknown = 0, kLive = 1, kDead = 2 };

enum class Arrival : std::uint8_t {
  kAccepted,
  kDuplicate,  ///< the sequence number of this head's newest frame again
  kLate,       ///< not newer than this head's newest frame, or so old that the head counts as dead
};

/// Per head, since the start or the last reset_counters().
struct HeadCounters {
  std::int64_t accepted = 0;
  std::int64_t duplicate = 0;
  std::int64_t late = 0;
  std::int64_t lost = 0;     ///< gaps in seq
  std::int64_t expired = 0;  ///< accepted, but the head died before its frame entered a cloud
};

class HeadSchedule {
 public:
  explicit HeadSchedule(const HeadParams& params);

  /// Judges and counts a frame; message time advances to it. Heads that are silent for dead_periods
  /// of message time die; their waiting frame expires.
  Arrival arrive(int head, std::int64_t utime_us, std::int64_t seq);

  /// The accepted frame of this head waits for the next cloud.
  void put(int head) { heads_[head].is_waiting = true; }
  bool is_waiting(int head) const { return heads_[head].is_waiting; }

  /// Something waits, and no live head is missing.
  bool is_complete() const;

  /// A cloud was made of all that waited.
  void take_all();

  HeadState state(int head) const { return heads_[head].state; }
  std::int64_t utime_us(int head) const { return heads_[head].utime_us; }
  double period_s(int head) const { return heads_[head].period_us * 1e-6; }
  const HeadCounters& counters(int head) const { return heads_[head].counters; }

  /// A new recording: everything is forgotten but the counters.
  void reset();

 private:
  struct Head {
    HeadState state = HeadState::kUnknown;
    bool is_waiting = false;
    std::int64_t utime_us = 0;
    std::int64_t seq = -1;
    double period_us = 0.0;
    HeadCounters counters;
  };

  void measure_period(Head& head, std::int64_t utime_us, std::int64_t seq) const;
  bool is_silence(const Head& head, std::int64_t age_us) const;
  void bury_silent_heads();

  HeadParams params_;
  std::array<Head, kNumHeads> heads_{};
  std::int64_t newest_utime_us_ = 0;
  bool had_cloud_ = false;
};

}  // namespace tof
