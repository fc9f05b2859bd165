// SPDX-License-Identifier: BSD-3-Clause
// From a device's time stamp to utime.
#pragma once

#include <cstdint>

#include "base/clock.h"

namespace sources {

/// A stamp of CLOCK_MONOTONIC as time since the epoch. One that is not near now is another clock's:
/// then the time of arrival serves.
inline std::int64_t utime_of_monotonic_us(std::int64_t stamp_us, const base::Now& now) {
  constexpr std::int64_t kOldestUs = 1'000'000;
  constexpr std::int64_t kAheadUs = 50'000;  // now was read before the device was
  const std::int64_t age_us = now.monotonic_us - stamp_us;
  if (age_us > kOldestUs || age_us < -kAheadUs) return now.utime_us;
  return now.utime_us - age_us;
}

/// The same for a stamp that claims to be time since the epoch.
inline std::int64_t utime_of_epoch_us(std::int64_t stamp_us, const base::Now& now) {
  return utime_of_monotonic_us(stamp_us - now.utime_us + now.monotonic_us, now);
}

}  // namespace sources
