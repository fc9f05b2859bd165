// SPDX-License-Identifier: BSD-3-Clause
// A whole ladder on kernel devices: controller and light plant as processes, sixteen axes on vcan0,
// touch and E-stop on a GPIO chip, candump beside them. It takes minutes, so it is no part of
// ctest:
//   ./scripts/vm --leap --vcan 1 --gpio-sim --write build --timeout 3000 --
//   build/release/tests/bin/hardware_climb_ladder
#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/hardware/bus_log.h"
#include "tests/hardware/process_bench.h"

namespace {

using hardware::ProcessBench;
using ::testing::HasSubstr;
using ::testing::Not;
using State = ProcessBench::State;

constexpr int kRungsToClimb = 10;
constexpr double kPatience_s = 1800.0;

/// The higher of both front claws.
int front_rung(const State& told) {
  return std::max(told.rung_id[0], told.rung_id[1]);
}

// Ten rungs, one after the other, without a stop; no frame is lost on the way.
TEST(LadderOnKernel, TenRungs) {
  hardware::BusLog log("vcan0");
  ProcessBench bench(LADDER_BIN_DIR, std::getenv("LADDER_GPIO_SIM"));
  ASSERT_TRUE(bench.bring_to_disarmed()) << bench.problems();
  ASSERT_EQ(bench.command({"arm"}), 0) << bench.problems();
  const auto holds = [](const State& told) { return told.state == State::STATE_HOLD; };
  ASSERT_TRUE(bench.wait_for(holds)) << bench.problems();
  const int first = front_rung(bench.now());
  bench.plant().signal(SIGUSR1);  // out of the dock
  ASSERT_EQ(bench.command({"climb"}), 0) << bench.problems();
  int highest = first;
  const auto has_ended = [&](const State& told) {
    if (front_rung(told) > highest) {
      highest = front_rung(told);
      std::printf("rung %d of %d\n", highest - first, kRungsToClimb);
      std::fflush(stdout);
    }
    return told.state != State::STATE_CLIMBING;
  };
  const auto took_us = bench.wait_for(has_ended, kPatience_s);
  ASSERT_TRUE(took_us) << bench.problems();
  EXPECT_EQ(bench.now().state, State::STATE_HOLD) << bench.problems();
  EXPECT_GE(highest - first, kRungsToClimb) << bench.problems();
  EXPECT_THAT(bench.plant().output(), Not(HasSubstr("FALLEN")));
  std::printf("%d rungs in %.0f s of the guest's clock; plant: %s\n", highest - first,
              1e-6 * static_cast<double>(*took_us), bench.plant().last_line().c_str());
  std::printf(
      "%lld cycles, %lld overruns, a cycle's work p50 %d p99 %d us, late p99 %d max %d us\n",
      static_cast<long long>(bench.now().cycles), static_cast<long long>(bench.now().overruns),
      bench.now().cycle_p50_us, bench.now().cycle_p99_us, bench.now().late_p99_us,
      bench.now().late_max_us);
  log.keep(LADDER_BUS_LOG);
}

}  // namespace
