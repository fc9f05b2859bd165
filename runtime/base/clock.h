// SPDX-License-Identifier: BSD-3-Clause
// Time as the services see it: handed in, never asked for.
#pragma once

#include <cstdint>

namespace base {

/// One moment on both clocks, in microseconds.
struct Now {
  std::int64_t monotonic_us = 0;  ///< for freshness and durations; never jumps
  std::int64_t utime_us = 0;      ///< since the epoch; comparable with a message's utime
};

}  // namespace base
