// SPDX-License-Identifier: BSD-3-Clause
// The operator's orders at every awkward moment: no order and no fault may lead where no order
// leads out again, and none of them moves what a fault holds.
#include <gtest/gtest.h>

#include "tests/climb/controller_fixture.h"

namespace climb {
namespace {

using climb_tests::kSession;
using climb_tests::params;
using S = ControllerState;

constexpr LimbState kStages[] = {
    LimbState::kUnloading, LimbState::kReleasing, LimbState::kRetracting,
    LimbState::kTransit,   LimbState::kPregrasp,  LimbState::kApproach,
    LimbState::kClosing,   LimbState::kVerify,    LimbState::kLoading};

class OrdersTest : public climb_tests::ControllerFixture {
 protected:
  bool all_loaded() const {
    for (const Leg leg : kLegs) {
      if (output_.limbs[leg] != LimbState::kLoaded) return false;
    }
    return true;
  }
};

// Hold, then pause, in each stage of a step: climb goes on and the step ends in HOLD, four claws
// on.
TEST_F(OrdersTest, PauseWhileFinishingIsNoDeadEnd) {
  for (const LimbState stage : kStages) {
    climb_to(stage);
    order(Order::kHold);
    order(Order::kPause);
    ASSERT_EQ(output_.state, S::kPaused) << name(stage);
    run(0.5);
    order(Order::kClimb);
    EXPECT_EQ(output_.command, CommandVerdict::kAccepted) << name(stage);
    order(Order::kHold);
    ASSERT_TRUE(reach(S::kHold, 60.0)) << name(stage) << where();
    EXPECT_TRUE(all_loaded()) << where();
  }
}

// HOLD ordered while paused in the middle of a step: the step is finished, then it holds.
TEST_F(OrdersTest, HoldFromPauseFinishesTheStep) {
  for (const LimbState stage : kStages) {
    climb_to(stage);
    order(Order::kPause);
    run(0.5);
    order(Order::kHold);
    EXPECT_EQ(output_.command, CommandVerdict::kAccepted) << name(stage);
    ASSERT_TRUE(reach(S::kHold, 60.0)) << name(stage) << where();
    EXPECT_TRUE(all_loaded());
  }
}

// A warning that comes while paused lets the step be finished, and no further one be begun.
TEST_F(OrdersTest, WarningWhilePausedIsNoDeadEnd) {
  climb_to(LimbState::kTransit);
  order(Order::kPause);
  stand_.input.faults = flag(Fault::kServoWarning);
  run(0.5);
  EXPECT_EQ(output_.state, S::kPaused);
  order(Order::kClimb);
  EXPECT_EQ(output_.command, CommandVerdict::kAccepted);
  ASSERT_TRUE(reach(S::kHold, 20.0)) << where();
  EXPECT_EQ(output_.rung_ids[kRearRight], 2);
  EXPECT_EQ(output_.rung_ids[kFrontRight], 3);
}

// HOLD ordered while perception is silent: it waits, goes on when it sees again, then holds.
TEST_F(OrdersTest, HoldWhileProtected) {
  climb_to(LimbState::kTransit);
  stand_.sees = false;
  ASSERT_TRUE(reach(S::kProtectiveHold, 1.0));
  order(Order::kHold);
  EXPECT_EQ(output_.command, CommandVerdict::kAccepted);
  run(1.0);
  EXPECT_EQ(output_.state, S::kProtectiveHold);
  stand_.sees = true;
  ASSERT_TRUE(reach(S::kHold, 60.0)) << where();
  EXPECT_TRUE(all_loaded());
}

// With a warning, a request to end, or nothing seen, no climb is begun from HOLD: not one cycle.
TEST_F(OrdersTest, ClimbIsRefusedWhileAnythingWouldStopIt) {
  ASSERT_TRUE(arm());
  for (const Fault fault : {Fault::kServoWarning, Fault::kTerminate}) {
    stand_.input.faults = flag(fault);
    order(Order::kClimb);
    EXPECT_EQ(output_.command, CommandVerdict::kNotNow) << name(fault);
    EXPECT_EQ(output_.state, S::kHold);
    EXPECT_FALSE(output_.body_shift);
  }
  stand_.input.faults = 0;
  stand_.sees = false;
  run(0.5);
  order(Order::kClimb);
  EXPECT_EQ(output_.command, CommandVerdict::kNotNow);
  EXPECT_EQ(output_.state, S::kHold);
}

// An order in the very cycle of a fault changes nothing: it stops, and a reset must come after it.
TEST_F(OrdersTest, OrdersInTheCycleOfAFault) {
  climb_to(LimbState::kTransit);
  const climb_tests::LadderStand stand = stand_;
  const Controller controller = controller_;
  for (const Order what : {Order::kArm, Order::kClimb, Order::kClimbDown, Order::kPause,
                           Order::kHold, Order::kReset, Order::kDisarm}) {
    for (const Fault fault : {Fault::kTracking, Fault::kServoSilent, Fault::kOverrun}) {
      stand_ = stand;
      controller_ = controller;
      stand_.input.faults = flag(fault);
      stand_.input.command = {what, kSession, ++seq_};
      cycle();
      EXPECT_EQ(output_.state, S::kFaultHold) << static_cast<int>(what);
      EXPECT_EQ(output_.reason, fault);
      EXPECT_EQ(output_.command, CommandVerdict::kNotNow);
    }
  }
}

// A reset is refused as long as the cause is there, however long everything has stood, and taken
// when it is gone.
TEST_F(OrdersTest, ResetWaitsForTheCause) {
  for (const Fault fault : {Fault::kServoFault, Fault::kBusDown, Fault::kLinesLost}) {
    start_anew();
    ASSERT_TRUE(arm()) << where();
    stand_.input.faults = flag(fault);
    run(2.0);
    order(Order::kReset);
    EXPECT_EQ(output_.command, CommandVerdict::kNotNow) << name(fault);
    EXPECT_TRUE(is_latched(output_.state)) << name(fault);
    stand_.input.faults = 0;
    cycle();
    order(Order::kReset);
    EXPECT_EQ(output_.command, CommandVerdict::kAccepted) << name(fault);
    EXPECT_EQ(output_.state, S::kDisarmed) << name(fault);
  }
}

// Back down after a part of the way up: the limb that moved last moves first, to where it came
// from.
TEST_F(OrdersTest, TurnsRoundOnTheSpot) {
  ASSERT_TRUE(arm());
  order(Order::kClimb);
  ASSERT_TRUE(reach_limb(kFrontRight, LimbState::kUnloading, 40.0)) << where();
  order(Order::kHold);
  ASSERT_TRUE(reach(S::kHold, 60.0)) << where();
  EXPECT_EQ(output_.rung_ids, (PerLeg<int>{3, 4, 1, 2})) << where();
  order(Order::kClimbDown);
  while (output_.state == S::kClimbing && all_loaded()) cycle();
  EXPECT_NE(output_.limbs[kFrontRight], LimbState::kLoaded) << where();
  ASSERT_TRUE(reach_limb(kFrontRight, LimbState::kLoaded, 20.0));
  EXPECT_EQ(stand_.held_rung(kFrontRight), 3) << where();
}

// The first target after enabling is the measured position, jaws too (invariant 6).
TEST_F(OrdersTest, BeginsWhereItStands) {
  climb_to(LimbState::kTransit);
  stand_.input.estop_clear = false;
  run(0.5);
  stand_.input.estop_clear = true;
  run(0.1);
  order(Order::kReset);
  run(0.1);
  order(Order::kArm);
  for (int i = 0; i < 100 && !output_.send; ++i) {
    const PerAxis<AxisReading> measured = stand_.input.axes;
    cycle();
    if (!output_.send) continue;
    for (int axis = 0; axis < kNumAxes; ++axis) {
      EXPECT_EQ(output_.axes[axis].position_rad, measured[axis].position_rad) << axis;
    }
  }
  EXPECT_TRUE(output_.send);
}

// While arming, hold and disarm end it: the claws stay as they are, nothing moves any more.
TEST_F(OrdersTest, ArmingCanBeEnded) {
  ASSERT_TRUE(reach(S::kDisarmed, 1.0));
  order(Order::kArm);
  ASSERT_TRUE(reach_limb(kFrontLeft, LimbState::kApproach, 10.0));
  order(Order::kHold);
  EXPECT_EQ(output_.command, CommandVerdict::kAccepted);
  EXPECT_EQ(output_.state, S::kDisarmed);
  EXPECT_FALSE(output_.send);
}

// A joint that stands farther outside its limits than a start may be, or nowhere: no drive is
// enabled, and the axis is told. A little outside it is armed, and led back inwards.
TEST_F(OrdersTest, ArmsOnlyWhereItsJointsMayStand) {
  const int axis = axis_of(kRearLeft, 1);
  const AxisLimits limits = axis_limits(params().climb.robot)[axis];
  ASSERT_TRUE(reach(S::kDisarmed, 1.0));
  const double slack_rad = params().gate.max_start_error_rad;
  for (const double bad_rad : {limits.max_rad + slack_rad + 0.001,
                               limits.min_rad - slack_rad - 0.001, climb_tests::kNan}) {
    stand_.input.axes[axis].position_rad = bad_rad;
    order(Order::kArm);
    EXPECT_EQ(output_.state, S::kDisarmed) << bad_rad;
    EXPECT_NE(output_.drives, DriveRequest::kEnable) << bad_rad;
    EXPECT_EQ(output_.gate.axis, axis) << bad_rad;
  }
  stand_.input.axes[axis].position_rad = limits.max_rad + 0.5 * slack_rad;
  order(Order::kArm);
  EXPECT_EQ(output_.drives, DriveRequest::kEnable) << where();
}

// Drives that leave the enabled state by themselves are a fault, whatever the bus says of it.
TEST_F(OrdersTest, DrivesThatDropOutAreAFault) {
  climb_to(LimbState::kTransit);
  stand_.input.drives_enabled = false;
  cycle();
  EXPECT_EQ(output_.state, S::kFaultHold);
  EXPECT_EQ(output_.reason, Fault::kServoState);
  run(0.5);
  stand_.input.drives_enabled = true;
  run(0.1);
  EXPECT_FALSE(output_.send);
}

// An orientation that is no rotation counts as none; the weight is still borne as it was.
TEST_F(OrdersTest, NoRotationIsASilentImu) {
  for (const double scale : {0.0, 0.5, 2.0, climb_tests::kNan, climb_tests::kInfinity}) {
    climb_to(LimbState::kTransit);
    run(0.2);
    const double torque_Nm = output_.axes[axis_of(kFrontLeft, 1)].torque_Nm;
    ASSERT_NE(torque_Nm, 0.0);
    stand_.input.imu.q_odom_body.coeffs() *= scale;
    cycle();
    EXPECT_EQ(output_.state, S::kFaultHold) << scale;
    EXPECT_EQ(output_.reason, Fault::kImuSilent) << scale;
    EXPECT_NEAR(output_.axes[axis_of(kFrontLeft, 1)].torque_Nm, torque_Nm, 0.5) << scale;
  }
}

}  // namespace
}  // namespace climb
