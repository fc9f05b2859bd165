// SPDX-License-Identifier: BSD-3-Clause
// Median and 95th percentile over the frames of one benchmark run, in thread CPU time, so that
// other work on the machine counts less. Google Benchmark itself reports means only.
#pragma once

#include <ctime>

#include <benchmark/benchmark.h>

#include "base/quantiles.h"

namespace bench {

class FrameTimes {
 public:
  void start() { started_ns_ = now_ns(); }
  void stop() { times_ns_.add(now_ns() - started_ns_); }

  /// Counters median_ms and p95_ms, of the newest frames.
  void report(benchmark::State& state) const {
    constexpr double kMilli_ns = 1e6;
    state.counters["median_ms"] = static_cast<double>(times_ns_.quantile(0.5)) / kMilli_ns;
    state.counters["p95_ms"] = static_cast<double>(times_ns_.quantile(0.95)) / kMilli_ns;
  }

 private:
  static std::int64_t now_ns() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
  }

  base::Quantiles times_ns_;
  std::int64_t started_ns_ = 0;
};

}  // namespace bench
