// SPDX-License-Identifier: BSD-3-Clause
// Judges the rhythm of the control cycle by the times handed in: late cycles, overruns, and a
// machine that slept (the clock that counts sleep ran ahead of the one that does not).
#pragma once

#include <cstdint>

#include "climb/failsafe.h"

namespace climb_controller {

struct CycleClockParams {
  std::int64_t period_us = 10'000;
  int max_late_periods = 3;            ///< a cycle begun later than so many is a fault
  std::int64_t max_sleep_us = 50'000;  ///< of the machine, between two cycles
};

class CycleClock {
 public:
  explicit CycleClock(const CycleClockParams& params) : params_(params) {}

  /// At the begin of each cycle: CLOCK_MONOTONIC and CLOCK_BOOTTIME. The faults of this cycle.
  climb::FaultFlags begin(std::int64_t now_us, std::int64_t boottime_us);

  std::int64_t num_cycles() const { return num_cycles_; }
  /// Begun more than one period late.
  std::int64_t num_overruns() const { return num_overruns_; }

 private:
  CycleClockParams params_;
  std::int64_t last_us_ = 0;
  std::int64_t last_slept_us_ = 0;
  std::int64_t num_cycles_ = 0;
  std::int64_t num_overruns_ = 0;
};

}  // namespace climb_controller
