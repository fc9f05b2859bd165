// SPDX-License-Identifier: BSD-3-Clause
// The whole of control without its messages, against the plant, in virtual time.
#include <gtest/gtest.h>

#include "cycle_bench.h"

namespace climb_controller {
namespace {

using climb::CommandVerdict;
using climb::ControllerState;
using climb::Fault;
using climb::Order;

bool arm(CycleBench& bench) {
  return bench.reach(ControllerState::kDisarmed) &&
         bench.order(Order::kArm) == CommandVerdict::kAccepted &&
         bench.reach(ControllerState::kHold, 120.0);
}

// From power-up by itself to DISARMED, armed on four rungs, one limb on its next rung, disarmed
// in the dock's absence because brakes hold; the monitor outside finds nothing to say.
TEST(ControlCycle, ClimbsOneRung) {
  CycleBench bench;
  ASSERT_TRUE(arm(bench)) << bench.problems();
  bench.plant.set_docked(false);
  ASSERT_EQ(bench.order(Order::kClimb), CommandVerdict::kAccepted) << bench.problems();
  const auto before = bench.report.output.rung_ids;
  bench.run_s(25.0);
  EXPECT_NE(bench.report.output.rung_ids, before) << bench.problems();
  ASSERT_EQ(bench.order(Order::kHold), CommandVerdict::kAccepted) << bench.problems();
  ASSERT_TRUE(bench.reach(ControllerState::kHold)) << bench.problems();
  ASSERT_EQ(bench.order(Order::kDisarm), CommandVerdict::kAccepted);
  EXPECT_TRUE(bench.reach(ControllerState::kDisarmed)) << bench.problems();
  EXPECT_EQ(bench.violations(), "");
}

// An E-stop is latched after its release; the operator's reset ends it, and then it can be armed.
TEST(ControlCycle, EstopIsLatchedUntilReset) {
  CycleBench bench;
  ASSERT_TRUE(bench.reach(ControllerState::kDisarmed));
  ASSERT_EQ(bench.order(Order::kArm), CommandVerdict::kAccepted);
  bench.run_s(0.1);
  bench.plant.press_estop(true);
  bench.step();
  EXPECT_EQ(bench.state(), ControllerState::kEstop);
  EXPECT_EQ(bench.order(Order::kReset), CommandVerdict::kNotNow);
  bench.run_s(0.1);
  bench.plant.press_estop(false);
  bench.run_s(0.5);
  EXPECT_EQ(bench.state(), ControllerState::kEstop);
  EXPECT_EQ(bench.order(Order::kReset), CommandVerdict::kAccepted) << bench.problems();
  EXPECT_EQ(bench.state(), ControllerState::kDisarmed);
  EXPECT_TRUE(arm(bench)) << bench.problems();
  EXPECT_EQ(bench.violations(), "");
}

}  // namespace
}  // namespace climb_controller
