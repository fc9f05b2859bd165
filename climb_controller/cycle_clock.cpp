// SPDX-License-Identifier: BSD-3-Clause
#include "climb_controller/cycle_clock.h"

namespace climb_controller {

climb::FaultFlags CycleClock::begin(std::int64_t now_us, std::int64_t boottime_us) {
  const std::int64_t slept_us = boottime_us - now_us;
  climb::FaultFlags faults = 0;
  if (num_cycles_ > 0) {
    const std::int64_t late_us = now_us - last_us_ - params_.period_us;
    if (late_us > params_.period_us) ++num_overruns_;
    if (late_us > params_.max_late_periods * params_.period_us) {
      faults |= climb::flag(climb::Fault::kOverrun);
    }
    if (slept_us - last_slept_us_ > params_.max_sleep_us) {
      faults |= climb::flag(climb::Fault::kSuspended);
    }
  }
  last_us_ = now_us;
  last_slept_us_ = slept_us;
  ++num_cycles_;
  return faults;
}

}  // namespace climb_controller
