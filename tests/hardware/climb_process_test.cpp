// SPDX-License-Identifier: BSD-3-Clause
// The robot's programs as they are started, on kernel devices: sixteen axes on vcan0 at 100 Hz,
// touch and E-stop on a GPIO chip, orders by ladder-command, rungs by LCM.
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/hardware/bus_log.h"
#include "tests/hardware/process_bench.h"

namespace {

using hardware::ProcessBench;
using ::testing::HasSubstr;
using ::testing::Not;
using State = ProcessBench::State;

// From power-up to operational, armed on four rungs, one complete limb cycle to a new rung from a
// message of rungs, held, disarmed. What crossed the bus is kept for decoders of others.
TEST(ClimbProcessOnKernel, WholeRun) {
  hardware::BusLog log("vcan0");
  ProcessBench bench(LADDER_BIN_DIR, std::getenv("LADDER_GPIO_SIM"));
  ASSERT_TRUE(bench.bring_to_disarmed()) << bench.problems();
  ASSERT_EQ(bench.command({"arm"}), 0) << bench.problems();
  ASSERT_TRUE(bench.wait_for([](const State& m) { return m.state == State::STATE_HOLD; }))
      << bench.problems();
  const std::vector<int> docked_rungs(std::begin(bench.now().rung_id),
                                      std::end(bench.now().rung_id));
  EXPECT_THAT(docked_rungs, ::testing::Each(::testing::Ge(0)));
  bench.plant().signal(SIGUSR1);  // out of the dock
  ASSERT_EQ(bench.command({"climb"}), 0) << bench.problems();
  ASSERT_TRUE(bench.wait_for([&docked_rungs](const State& m) {
    for (std::size_t leg = 0; leg < 4; ++leg) {
      if (m.rung_id[leg] != docked_rungs[leg]) return true;
    }
    return false;
  })) << bench.problems();
  ASSERT_EQ(bench.command({"hold"}), 0) << bench.problems();
  ASSERT_EQ(bench.command({"disarm"}), 0) << bench.problems();
  EXPECT_TRUE(bench.plant().comes_to_show("enabled  0")) << bench.problems();
  EXPECT_THAT(bench.plant().output(), Not(HasSubstr("FALLEN")));
  std::printf(
      "%lld cycles, %lld overruns, a cycle's work p50 %d p99 %d us, late p99 %d max %d us\n",
      static_cast<long long>(bench.now().cycles), static_cast<long long>(bench.now().overruns),
      bench.now().cycle_p50_us, bench.now().cycle_p99_us, bench.now().late_p99_us,
      bench.now().late_max_us);
  log.keep(LADDER_BUS_LOG);
}

}  // namespace
