// SPDX-License-Identifier: BSD-3-Clause
// The control cycle takes nothing from the heap: not while it is brought up, armed or climbing.
#include <gtest/gtest.h>

#include "cycle_bench.h"
#include "tests/support/allocation_counter.h"

namespace climb_controller {
namespace {

using climb::ControllerState;
using climb::Order;

// Not a byte in any cycle from power-up over arming, two steps of limbs, an E-stop and a reset.
TEST(ControlCycleAllocation, None) {
  CycleBench bench;
  std::size_t before = 0;
  std::size_t taken = 0;
  int num_cycles = 0;
  const auto count_on = [&] { before = test_support::num_allocations(); };
  const auto count_off = [&] { taken += test_support::num_allocations() - before; };
  bench.before_step = [&] {
    ++num_cycles;
    count_on();
    bench.transport.on_enter = count_off;
    bench.transport.on_leave = count_on;
  };
  bench.after_step = [&] {
    count_off();
    bench.transport.on_enter = bench.transport.on_leave = nullptr;
  };
  ASSERT_TRUE(bench.reach(ControllerState::kDisarmed)) << bench.problems();
  EXPECT_EQ(taken, 0U) << "while the bus was brought up";
  bench.order(Order::kArm);
  ASSERT_TRUE(bench.reach(ControllerState::kHold, 60.0)) << bench.problems();
  EXPECT_EQ(taken, 0U) << "while arming";
  bench.plant.set_docked(false);
  bench.order(Order::kClimb);
  bench.run_s(15.0);
  EXPECT_EQ(bench.state(), ControllerState::kClimbing) << bench.problems();
  EXPECT_EQ(taken, 0U) << "while climbing";
  bench.plant.press_estop(true);
  bench.run_s(0.5);
  bench.plant.press_estop(false);
  bench.run_s(0.5);
  bench.order(Order::kReset);
  bench.run_s(0.5);
  EXPECT_EQ(taken, 0U) << "while it stopped and was reset";
  EXPECT_GT(num_cycles, 2000);
}

}  // namespace
}  // namespace climb_controller
