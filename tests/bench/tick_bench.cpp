// SPDX-License-Identifier: BSD-3-Clause
// One tick of control with sixteen axes while climbing: frames in, controller, frames out. CPU time
// of the thread, of the tick alone; the simulated robot beside it is not counted.
#include <algorithm>
#include <ctime>
#include <vector>

#include <benchmark/benchmark.h>

#include "tests/climb_service/cycle_bench.h"

namespace {

constexpr int kNumTicks = 3000;

double thread_cpu_us() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e6 * static_cast<double>(time.tv_sec) + 1e-3 * static_cast<double>(time.tv_nsec);
}

/// "climb/tick": median and 99.9 % of the ticks of 30 s of climbing.
void climb_tick(benchmark::State& state) {
  using climb::ControllerState;
  climb_controller::CycleBench bench;
  bench.reach(ControllerState::kDisarmed);
  bench.order(climb::Order::kArm);
  bench.reach(ControllerState::kHold, 60.0);
  bench.plant.set_docked(false);
  bench.order(climb::Order::kClimb);
  if (bench.state() != ControllerState::kClimbing) {
    state.SkipWithError("it does not climb");
    return;
  }
  std::vector<double> ticks_us;
  double begin_us = 0.0;
  bench.before_step = [&] { begin_us = thread_cpu_us(); };
  bench.after_step = [&] { ticks_us.push_back(thread_cpu_us() - begin_us); };
  for (auto _ : state) {
    bench.step();
    state.SetIterationTime(1e-6 * ticks_us.back());
  }
  std::sort(ticks_us.begin(), ticks_us.end());
  state.counters["p50_us"] = ticks_us[ticks_us.size() / 2];
  state.counters["p99.9_us"] = ticks_us[ticks_us.size() * 999 / 1000];
}
BENCHMARK(climb_tick)
    ->Name("climb/tick")
    ->Iterations(kNumTicks)
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond);

}  // namespace
