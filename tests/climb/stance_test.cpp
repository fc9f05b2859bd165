// SPDX-License-Identifier: BSD-3-Clause
// What carries the robot: a stance lost in the middle of a step, stances to rest in, the way down
// and the dock.
#include <gtest/gtest.h>

#include "climb/step_order.h"
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

class StanceTest : public climb_tests::ControllerFixture {
 protected:
  int num_loaded() const {
    int num = 0;
    for (const Leg leg : kLegs) num += output_.limbs[leg] == LimbState::kLoaded ? 1 : 0;
    return num;
  }
  bool climb_and_hold(double seconds) {
    order(Order::kClimb);
    run(seconds);
    order(Order::kHold);
    return reach(S::kHold, 60.0);
  }
};

// A front claw loses its rung while a rear limb is in any stage of its step: within 40 ms
// everything is frozen in FAULT_HOLD for that one reason, then the limb in the air alone is put
// down and verified: three claws hold, and no alarm is left.
TEST_F(StanceTest, PutsTheLimbInTheAirDown) {
  for (const LimbState stage : kStages) {
    climb_to(stage);
    stand_.drop(kFrontLeft);
    ASSERT_TRUE(reach(S::kFaultHold, 0.04)) << name(stage) << where();
    EXPECT_EQ(output_.reason, Fault::kStanceLost) << name(stage);
    EXPECT_EQ(output_.limbs[kFrontLeft], LimbState::kSupportLost);
    run(0.15);
    const PerAxis<AxisCommand> frozen = output_.axes;
    cycle();
    for (int axis = 0; axis < kNumAxes; ++axis) {
      if (axis % kNumAxesPerLeg == kJaw) continue;
      EXPECT_NEAR(output_.axes[axis].position_rad, frozen[axis].position_rad, 1e-9) << name(stage);
    }
    for (int i = 0; i < 3000 && num_loaded() < 3; ++i) {
      cycle();
      for (const Leg leg : {kFrontRight, kRearLeft}) {
        for (int joint = 0; joint < kNumLegJoints; ++joint) {
          const int axis = axis_of(leg, joint);
          ASSERT_NEAR(output_.axes[axis].position_rad, frozen[axis].position_rad, 1e-9);
        }
      }
    }
    run(0.1);
    EXPECT_EQ(num_loaded(), 3) << name(stage) << where();
    EXPECT_EQ(output_.state, S::kFaultHold);
    EXPECT_EQ(output_.reason, Fault::kStanceLost);
    EXPECT_FALSE(output_.fall_alarm) << name(stage);
    EXPECT_FALSE(output_.putting_down) << name(stage);
  }
}

// Rung 1 held both rear claws: the rear right one, off it already, goes on to rung 2, not back.
TEST_F(StanceTest, DoesNotGoBackToTheBrokenRung) {
  climb_to(LimbState::kTransit);
  stand_.break_rung(1);
  ASSERT_TRUE(reach(S::kFaultHold, 0.06)) << where();
  run(20.0);
  EXPECT_EQ(output_.limbs[kRearRight], LimbState::kLoaded) << where();
  EXPECT_EQ(output_.rung_ids[kRearRight], 2);
  EXPECT_FALSE(output_.fall_alarm);
}

// While it is put down no order is taken; a further fault ends it at once and for good, and so does
// the E-stop.
TEST_F(StanceTest, PuttingDownEndsOnAnyFurtherFault) {
  for (const Fault fault : {Fault::kServoFault, Fault::kBusDown, Fault::kTilt, Fault::kEstop}) {
    climb_to(LimbState::kTransit);
    stand_.drop(kFrontLeft);
    ASSERT_TRUE(reach(S::kFaultHold, 0.04));
    run(0.5);
    ASSERT_TRUE(output_.putting_down) << where();
    for (const Order what :
         {Order::kClimb, Order::kPause, Order::kHold, Order::kReset, Order::kDisarm, Order::kArm}) {
      order(what);
      EXPECT_EQ(output_.command, CommandVerdict::kNotNow) << static_cast<int>(what);
    }
    stand_.input.faults = flag(fault);
    run(0.4);
    EXPECT_FALSE(output_.putting_down) << name(fault);
    const PerLeg<LimbState> stood = output_.limbs;
    const LegAngles angles_rad = stand_.measured_rad(kRearRight);
    run(0.5);
    EXPECT_EQ(output_.limbs, stood) << name(fault);
    EXPECT_LE((stand_.measured_rad(kRearRight) - angles_rad).norm(), 1e-3) << name(fault);
    stand_.input.faults = 0;  // it passes: nothing goes on by itself
    run(0.5);
    EXPECT_FALSE(output_.putting_down) << name(fault);
    EXPECT_EQ(output_.limbs, stood) << name(fault);
  }
}

// Two stances lost at once, or nowhere to put the limb down: the fall alarm, and all claws close.
TEST_F(StanceTest, RaisesTheFallAlarm) {
  climb_to(LimbState::kTransit);
  stand_.drop(kFrontLeft);
  stand_.drop(kRearLeft);
  ASSERT_TRUE(reach(S::kFaultHold, 0.04)) << where();
  EXPECT_EQ(output_.reason, Fault::kTooFewGrasps);
  EXPECT_TRUE(output_.fall_alarm);
  run(1.0);
  for (const Leg leg : kLegs) EXPECT_LT(output_.axes[axis_of(leg, kJaw)].position_rad, -0.5);

  climb_to(LimbState::kTransit);
  stand_.break_rung(1);
  stand_.break_rung(2);
  ASSERT_TRUE(reach(S::kFaultHold, 0.06)) << where();
  run(60.0);
  EXPECT_TRUE(output_.fall_alarm) << where();
}

// At rest one lost claw leaves three: FAULT_HOLD without the fall alarm; after reset and arming the
// lost one grasps a rung again, not the one that it lost.
TEST_F(StanceTest, RecoversALostClaw) {
  ASSERT_TRUE(arm());
  ASSERT_TRUE(climb_and_hold(3.0)) << where();
  EXPECT_EQ(output_.rung_ids, (PerLeg<int>{3, 4, 1, 2}));
  stand_.break_rung(1);
  ASSERT_TRUE(reach(S::kFaultHold, 0.05)) << where();
  EXPECT_EQ(output_.reason, Fault::kStanceLost);
  EXPECT_FALSE(output_.fall_alarm);
  run(0.5);
  order(Order::kReset);
  ASSERT_EQ(output_.state, S::kDisarmed) << where();
  order(Order::kArm);
  ASSERT_TRUE(reach(S::kHold, 60.0)) << where();
  EXPECT_EQ(output_.rung_ids[kRearLeft], 2) << where();
}

// HOLD ordered in whatever step ends in a stance that survives any broken rung; ordered twice,
// after the step in the air.
TEST_F(StanceTest, RestsWhereAnyRungMayBreak) {
  for (const double after_s : {0.1, 5.0, 12.0, 20.0, 28.0, 33.0}) {
    start_anew();
    ASSERT_TRUE(arm());
    ASSERT_TRUE(climb_and_hold(after_s)) << where();
    EXPECT_TRUE(is_staggered(output_.rung_ids))
        << after_s << " " << output_.rung_ids[0] << output_.rung_ids[1] << output_.rung_ids[2]
        << output_.rung_ids[3] << where();
    EXPECT_TRUE(output_.rests_safely) << after_s;
  }
  start_anew();
  ASSERT_TRUE(arm());
  order(Order::kClimb);
  ASSERT_TRUE(reach_limb(kRearRight, LimbState::kTransit, 20.0));
  order(Order::kHold);
  order(Order::kHold);
  ASSERT_TRUE(reach(S::kHold, 20.0));
  EXPECT_EQ(output_.rung_ids, (PerLeg<int>{3, 3, 1, 2}));
  EXPECT_FALSE(output_.rests_safely);
}

// The top is told by place: rungs numbered anew on the way change nothing, a rung of nonsense above
// neither.
TEST_F(StanceTest, KnowsTheTopByPlace) {
  ASSERT_TRUE(arm());
  order(Order::kClimb);
  ASSERT_TRUE(reach(S::kHold, 400.0)) << where();
  for (RungView& rung : stand_.rungs) rung.id += 100;
  RungView nonsense = stand_.rungs.back();
  nonsense.id = 7;
  nonsense.end0_m.z() = climb_tests::kNan;
  stand_.rungs.push_back(nonsense);
  run(0.1);
  order(Order::kClimb);
  ASSERT_TRUE(reach(S::kHold, 3.0)) << where();
  EXPECT_TRUE(output_.at_top) << where();
}

// Below a rung that is seen but not trusted it is not at the top: it holds for that reason, and
// when the rung is trusted while it looks again it goes on.
TEST_F(StanceTest, ARungNotTrustedIsNoTop) {
  stand_.rungs.back().trusted = false;
  ASSERT_TRUE(arm());
  order(Order::kClimb);
  ASSERT_TRUE(reach(S::kHold, 400.0)) << where();
  EXPECT_FALSE(output_.at_top);
  EXPECT_EQ(output_.refusal, Refusal::kNotTrusted) << where();
  order(Order::kClimb);
  run(1.0);
  EXPECT_EQ(output_.state, S::kClimbing) << where();
  stand_.rungs.back().trusted = true;
  ASSERT_TRUE(reach(S::kHold, 100.0)) << where();
  EXPECT_TRUE(output_.at_top) << where();
  EXPECT_EQ(output_.rung_ids[kFrontLeft], 9);
}

// A rung that is seen above only now and then is no top either, nor is one below a gap; what is far
// off the ladder's line or higher than any next rung does not count.
TEST_F(StanceTest, TheTopIsThatWhileItLooks) {
  ASSERT_TRUE(arm());
  order(Order::kClimb);
  ASSERT_TRUE(reach(S::kHold, 400.0)) << where();
  ASSERT_TRUE(output_.at_top);
  stand_.add_rung_at(10.0);
  RungView& above = stand_.rungs.back();
  above.trusted = false;
  const RungView next = above;
  const auto look = [&](const Eigen::Vector3d& off_m, bool flickers) {
    above.end0_m = next.end0_m + off_m;
    above.end1_m = next.end1_m + off_m;
    cycle();
    order(Order::kClimb);
    for (int i = 0; i < 3000 && output_.state != S::kHold; ++i) {
      const bool is_seen = !flickers || i % 50 == 0;
      above.end0_m.setConstant(climb_tests::kNan);
      if (is_seen) above.end0_m = next.end0_m + off_m;
      cycle();
    }
    EXPECT_EQ(output_.state, S::kHold) << where();
    return output_.at_top;
  };
  EXPECT_FALSE(look({0.0, 0.0, 0.0}, false));
  EXPECT_FALSE(look({0.0, 0.0, 0.0}, true));
  EXPECT_FALSE(look({0.0, 0.0, 0.4}, false));
  EXPECT_EQ(output_.refusal, Refusal::kRungMissing) << where();
  EXPECT_TRUE(look({0.0, 0.0, 0.9}, false));
  EXPECT_TRUE(look({0.3, 0.0, 0.0}, false));
}

// A long ladder is climbed to its end: errors of the odometry do not add up against the rungs.
TEST_F(StanceTest, ClimbsALongLadder) {
  start_anew();
  stand_ = climb_tests::LadderStand(params().climb, 24);
  ASSERT_TRUE(arm());
  order(Order::kClimb);
  ASSERT_TRUE(reach(S::kHold, 1500.0)) << where();
  EXPECT_TRUE(output_.at_top) << where();
}

// Up, down to the dock, and there disarmed: the claws open one after the other, the drives go off,
// and from there it is armed again.
TEST_F(StanceTest, GoesUpAndDownToTheDock) {
  ASSERT_TRUE(arm());
  order(Order::kClimb);
  ASSERT_TRUE(reach(S::kHold, 400.0));
  order(Order::kDisarm);
  EXPECT_EQ(output_.command, CommandVerdict::kNotNow);
  order(Order::kClimbDown);
  ASSERT_TRUE(reach(S::kHold, 400.0)) << where();
  EXPECT_TRUE(output_.at_dock) << where();
  for (const Leg leg : kLegs) EXPECT_EQ(stand_.held_rung(leg), is_front(leg) ? 3 : 1);
  EXPECT_NEAR(stand_.body_height_m(), 0.0, 0.01);
  order(Order::kDisarm);
  EXPECT_EQ(output_.state, S::kDisarming);
  ASSERT_TRUE(reach(S::kDisarmed, 30.0)) << where();
  EXPECT_FALSE(stand_.input.drives_enabled);
  for (const Leg leg : kLegs) EXPECT_FALSE(stand_.held(leg));
  run(0.5);
  order(Order::kArm);
  ASSERT_TRUE(reach(S::kHold, 60.0)) << where();
  EXPECT_EQ(num_loaded(), 4);
}

// Disarmed at the dock's place, but the dock is not there: the body sags, no claw opens, HOLD.
TEST_F(StanceTest, OpensNoClawWhereNoDockHolds) {
  ASSERT_TRUE(arm());
  run(1.0);
  stand_.sags = true;
  order(Order::kDisarm);
  EXPECT_EQ(output_.state, S::kDisarming);
  ASSERT_TRUE(reach(S::kHold, 2.0)) << where();
  EXPECT_EQ(num_loaded(), 4);
  for (const Leg leg : kLegs) EXPECT_TRUE(stand_.held(leg));
}

// A jaw that does not open in the dock: a fault, not for ever.
TEST_F(StanceTest, AJawThatDoesNotOpenInTheDock) {
  ASSERT_TRUE(arm());
  stand_.stuck_jaw_rad[kFrontRight] = params().climb.robot.claw.on_rung_rad;
  order(Order::kDisarm);
  ASSERT_TRUE(reach(S::kFaultHold, 30.0)) << where();
  EXPECT_EQ(output_.reason, Fault::kTracking);
}

}  // namespace
}  // namespace climb
