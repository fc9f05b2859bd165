// SPDX-License-Identifier: BSD-3-Clause
#include "runtime/clock.h"

#include <ctime>

namespace runtime {
namespace {

std::int64_t read_us(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<std::int64_t>(time.tv_sec) * 1'000'000 + time.tv_nsec / 1'000;
}

}  // namespace

base::Now clock_now() {
  return {.monotonic_us = read_us(CLOCK_MONOTONIC), .utime_us = read_us(CLOCK_REALTIME)};
}

}  // namespace runtime
