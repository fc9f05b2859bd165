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

// Arming that is called off while the drives are being enabled ends there: no drive is enabled
// after the operator's HOLD.
TEST(ControlCycle, HoldEndsEnabling) {
  CycleBench bench;
  ASSERT_TRUE(bench.reach(ControllerState::kDisarmed));
  ASSERT_EQ(bench.order(Order::kArm), CommandVerdict::kAccepted);
  ASSERT_EQ(bench.report.bus_phase, can::BusPhase::kEnabling);
  ASSERT_EQ(bench.order(Order::kHold), CommandVerdict::kAccepted);
  for (int i = 0; i < 20; ++i) {
    bench.step();
    for (const simulator::CarriedFrame& frame : bench.carried) {
      const bool is_target = frame.frame.id > 0x200 && frame.frame.id <= 0x210;
      const bool enables = (frame.frame.bytes[0] & 0x0F) == 0x0F;
      EXPECT_FALSE(is_target && enables) << "cycle " << i;
    }
  }
  EXPECT_EQ(bench.state(), ControllerState::kDisarmed);
  EXPECT_TRUE(arm(bench)) << bench.problems();
}

simulator::PlantParams without_hold_on_loss() {
  simulator::PlantParams params;
  for (simulator::DriveParams& drive : params.drives) drive.objects.abort_connection_option = false;
  return params;
}

// Drives that would not hold by themselves are never armed for climbing; the object is named.
TEST(ControlCycle, RefusesDrivesWithoutHoldOnLoss) {
  CycleBench bench(without_hold_on_loss());
  bench.run_s(5.0);
  EXPECT_EQ(bench.reason(), Fault::kConfiguration) << bench.problems();
  EXPECT_EQ(bench.order(Order::kArm), CommandVerdict::kNotNow);
  EXPECT_EQ(bench.report.policy, Policy::kNoHoldOnLoss);
  EXPECT_NE(bench.problems().find("6007h"), std::string::npos) << bench.problems();
  bench.run_s(1.0);
  EXPECT_NE(bench.report.bus_phase, can::BusPhase::kEnabled);
  EXPECT_EQ(bench.violations(), "");
}

// Allowed for ground tests, the same drives are armed where they stand, hold, and never climb.
TEST(ControlCycle, GroundTestHoldsAndNeverClimbs) {
  CycleParams params;
  params.allow_no_hold_on_loss = true;
  CycleBench bench(without_hold_on_loss(), params);
  ASSERT_TRUE(arm(bench)) << bench.problems();
  const auto before = bench.report.axes;
  bench.run_s(1.0);
  for (int axis = 0; axis < climb::kNumAxes; ++axis) {
    EXPECT_NEAR(bench.report.axes[axis].position_rad, before[axis].position_rad, 1e-3);
  }
  EXPECT_EQ(bench.order(Order::kClimb), CommandVerdict::kNotNow);
  EXPECT_EQ(bench.report.policy, Policy::kGroundTest);
  EXPECT_EQ(bench.order(Order::kDisarm), CommandVerdict::kAccepted);
  EXPECT_TRUE(bench.reach(ControllerState::kDisarmed));
  EXPECT_EQ(bench.violations(), "");
}

// With nothing to hold it without power, which is so unless somebody states otherwise, the robot is
// armed in the dock and never leaves it.
TEST(ControlCycle, WithoutPowerOffHoldItNeverLeavesTheGround) {
  CycleBench bench({}, CycleParams());
  ASSERT_TRUE(arm(bench)) << bench.problems();
  EXPECT_EQ(bench.order(Order::kClimb), CommandVerdict::kNotNow);
  EXPECT_EQ(bench.report.policy, Policy::kNoPowerOffHold);
}

// An order of another session, a repeated number, and silence change nothing; the number that the
// operator continues from is not taken from a stranger.
TEST(ControlCycle, OrdersOfOthersChangeNothing) {
  CycleBench bench;
  ASSERT_TRUE(bench.reach(ControllerState::kDisarmed));
  bench.inbox.command = {Order::kArm, kSession + 1, 1000};
  bench.step();
  EXPECT_EQ(bench.report.verdict, CommandVerdict::kWrongSession);
  EXPECT_EQ(bench.report.order_seq, -1);
  bench.inbox.command = {Order::kPause, kSession, 7};
  bench.step();
  EXPECT_EQ(bench.report.verdict, CommandVerdict::kNotNow);
  bench.inbox.command = {Order::kArm, kSession, 7};
  bench.step();
  EXPECT_EQ(bench.report.verdict, CommandVerdict::kReplayed);
  bench.run_s(1.0);
  EXPECT_EQ(bench.state(), ControllerState::kDisarmed);
  EXPECT_EQ(bench.violations(), "");
}

// A drive that restarted in service has lost its configuration: FAULT_HOLD, and the reset brings it
// back before the next arming.
TEST(ControlCycle, ResetConfiguresARestartedDriveAgain) {
  CycleBench bench;
  ASSERT_TRUE(arm(bench)) << bench.problems();
  bench.plant.reboot(6);
  bench.run_s(0.5);
  EXPECT_EQ(bench.state(), ControllerState::kFaultHold);
  EXPECT_EQ(bench.reason(), Fault::kServoState) << bench.problems();
  EXPECT_EQ(bench.order(Order::kReset), CommandVerdict::kAccepted) << bench.problems();
  EXPECT_EQ(bench.state(), ControllerState::kDisarmed) << bench.problems();
  EXPECT_TRUE(bench.report.bus_faults.size == 0) << bench.problems();
}

// Where the claws held in the dock, but no dock is there: position loops keep the body from
// sagging, the torques tell, and the claws stay closed.
TEST(ControlCycle, DisarmingWithoutADockHolds) {
  CycleBench bench;
  ASSERT_TRUE(bench.reach(ControllerState::kDisarmed));
  ASSERT_EQ(bench.order(Order::kArm), CommandVerdict::kAccepted);
  ASSERT_TRUE(bench.reach(ControllerState::kHold, 60.0)) << bench.problems();
  bench.plant.set_docked(false);
  bench.run_s(2.0);
  EXPECT_EQ(bench.order(Order::kDisarm), CommandVerdict::kAccepted);
  bench.run_s(10.0);
  EXPECT_EQ(bench.state(), ControllerState::kHold) << bench.problems();
  EXPECT_FALSE(bench.plant.truth().fallen);
  for (int leg = 0; leg < simulator::kNumLegs; ++leg) EXPECT_TRUE(bench.plant.leg(leg).holds);
  bench.plant.set_docked(true);
  bench.run_s(1.0);
  EXPECT_EQ(bench.order(Order::kDisarm), CommandVerdict::kAccepted);
  EXPECT_TRUE(bench.reach(ControllerState::kDisarmed, 60.0)) << bench.problems();
}

// The same while disarmed: it cannot be armed, the reset heals it, nothing heals itself.
TEST(ControlCycle, ResetWhileDisarmedBringsTheBusBack) {
  CycleBench bench;
  ASSERT_TRUE(bench.reach(ControllerState::kDisarmed));
  bench.plant.reboot(3);
  bench.run_s(4.0);
  EXPECT_EQ(bench.state(), ControllerState::kDisarmed);
  EXPECT_NE(bench.reason(), Fault::kNone) << bench.problems();
  EXPECT_EQ(bench.order(Order::kArm), CommandVerdict::kNotNow);
  EXPECT_EQ(bench.order(Order::kReset), CommandVerdict::kAccepted) << bench.problems();
  EXPECT_EQ(bench.reason(), Fault::kNone) << bench.problems();
  EXPECT_TRUE(arm(bench)) << bench.problems();
  EXPECT_EQ(bench.violations(), "");
}

// A reset while drives follow targets, although one of them warns: refused, and no drive stops.
TEST(ControlCycle, ResetWhileItHoldsStopsNoDrive) {
  CycleBench bench;
  ASSERT_TRUE(arm(bench)) << bench.problems();
  bench.plant.warn(6, 0x3120);
  bench.run_s(0.1);
  ASSERT_GT(bench.report.bus_faults.size, 0U) << bench.problems();
  EXPECT_NE(bench.order(Order::kReset), CommandVerdict::kAccepted);
  EXPECT_EQ(bench.report.bus_phase, can::BusPhase::kEnabled) << bench.problems();
  EXPECT_EQ(bench.state(), ControllerState::kHold) << bench.problems();
  EXPECT_EQ(bench.violations(), "");
}

// An E-stop that is pressed at power-up stops a bus that was never configured; released and reset,
// the robot comes up as always.
TEST(ControlCycle, EstopAtPowerUp) {
  CycleBench bench;
  bench.plant.press_estop(true);
  bench.run_s(3.0);
  EXPECT_EQ(bench.state(), ControllerState::kEstop);
  bench.plant.press_estop(false);
  bench.run_s(0.5);
  EXPECT_EQ(bench.order(Order::kReset), CommandVerdict::kAccepted) << bench.problems();
  EXPECT_TRUE(arm(bench)) << bench.problems();
  EXPECT_EQ(bench.violations(), "");
}

// Before anything was armed the bus is brought up again and again, without being asked.
TEST(ControlCycle, WaitsForDrivesThatComeLate) {
  CycleBench bench;
  for (int axis = 0; axis < climb::kNumAxes; ++axis) bench.plant.drive(axis).faults.silent = true;
  bench.run_s(6.0);
  EXPECT_EQ(bench.state(), ControllerState::kBoot);
  for (int axis = 0; axis < climb::kNumAxes; ++axis) bench.plant.drive(axis).faults.silent = false;
  EXPECT_TRUE(bench.reach(ControllerState::kDisarmed)) << bench.problems();
}

}  // namespace
}  // namespace climb_controller
