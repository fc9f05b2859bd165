// SPDX-License-Identifier: BSD-3-Clause
// The controller as a whole on a kinematic stand: start, arm in the dock, climb, and stops.
#include "climb/controller.h"

#include <gtest/gtest.h>

#include "tests/climb/controller_fixture.h"

namespace climb {
namespace {

using climb_tests::kSession;
using climb_tests::params;
using S = ControllerState;

class ControllerTest : public climb_tests::ControllerFixture {};

// Nothing is sent before arming, and the parameters as they come are sound.
TEST_F(ControllerTest, BootsToDisarmedAndSendsNothing) {
  EXPECT_EQ(check(params()), "");
  for (int i = 0; i < 100; ++i) {
    cycle();
    ASSERT_FALSE(output_.send);
    ASSERT_EQ(output_.drives, DriveRequest::kNone);
  }
  EXPECT_EQ(output_.state, S::kDisarmed) << where();
}

// Only this run's session arms, and a command that came before is not taken twice.
TEST_F(ControllerTest, ArmsForThisSessionOnly) {
  ASSERT_TRUE(reach(S::kDisarmed, 1.0));
  order(Order::kArm, kSession + 1);
  EXPECT_EQ(output_.command, CommandVerdict::kWrongSession);
  order(Order::kArm, 0);
  EXPECT_EQ(output_.command, CommandVerdict::kWrongSession);
  EXPECT_EQ(output_.state, S::kDisarmed);
  order(Order::kClimb);
  EXPECT_EQ(output_.command, CommandVerdict::kNotNow);
  stand_.input.command = {Order::kArm, kSession, seq_};
  cycle();
  EXPECT_EQ(output_.command, CommandVerdict::kReplayed);
  order(Order::kArm);
  EXPECT_EQ(output_.state, S::kArming);
}

// In the dock all four claws grasp and are verified, one after the other; then HOLD.
TEST_F(ControllerTest, GraspsInTheDock) {
  ASSERT_TRUE(arm()) << where();
  for (const Leg leg : kLegs) {
    EXPECT_TRUE(stand_.held(leg));
    EXPECT_EQ(output_.limbs[leg], LimbState::kLoaded);
    EXPECT_EQ(output_.rung_ids[leg], is_front(leg) ? 3 : 1);
    EXPECT_TRUE(controller_.limb(leg).last_witness().all());
  }
}

// From the dock to the top rung of nine: every claw one rung after another, and HOLD at the top.
TEST_F(ControllerTest, ClimbsToTheTop) {
  ASSERT_TRUE(arm()) << where();
  order(Order::kClimb);
  ASSERT_TRUE(reach(S::kHold, 400.0)) << where();
  EXPECT_TRUE(output_.at_top) << where();
  EXPECT_EQ(output_.rung_ids[kFrontLeft], 9);
  EXPECT_EQ(output_.rung_ids[kFrontRight], 9);
  EXPECT_NEAR(stand_.body_height_m(), 1.95, 0.1);  // it rose to look
}

// The E-stop stops in every stage, sends nothing more, and leaves only by reset when clear; then
// nothing moves until armed again, and the claws that held are still held.
TEST_F(ControllerTest, StopsAndRearms) {
  ASSERT_TRUE(arm()) << where();
  order(Order::kClimb);
  ASSERT_TRUE(reach_limb(kRearRight, LimbState::kTransit, 20.0)) << where();
  stand_.input.estop_clear = false;
  cycle();
  EXPECT_EQ(output_.state, S::kEstop);
  EXPECT_EQ(output_.reason, Fault::kEstop);
  EXPECT_FALSE(output_.send);
  EXPECT_EQ(output_.drives, DriveRequest::kQuickStop);
  order(Order::kReset);
  EXPECT_EQ(output_.command, CommandVerdict::kNotNow);
  stand_.input.estop_clear = true;
  for (int i = 0; i < 100; ++i) cycle();
  EXPECT_EQ(output_.state, S::kEstop);
  order(Order::kReset);
  EXPECT_EQ(output_.state, S::kDisarmed);
  order(Order::kArm);
  ASSERT_TRUE(reach(S::kHold, 30.0)) << where();
  for (const Leg leg : kLegs) EXPECT_TRUE(stand_.held(leg)) << where();
}

// Every fault that latches while climbing does so from each stage of a step, with its own reason;
// the foot stands within 0.3 s and no other claw opens.
TEST_F(ControllerTest, HoldsOnEveryFaultInEveryStage) {
  for (const LimbState stage :
       {LimbState::kUnloading, LimbState::kReleasing, LimbState::kRetracting, LimbState::kTransit,
        LimbState::kApproach, LimbState::kClosing, LimbState::kVerify, LimbState::kLoading}) {
    climb_tests::LadderStand stand(params().climb);
    Controller controller(params());
    std::swap(stand_, stand);
    std::swap(controller_, controller);
    output_ = ControllerOutput();
    ASSERT_TRUE(arm()) << where();
    order(Order::kClimb);
    ASSERT_TRUE(reach_limb(kRearRight, stage, 20.0)) << where();
    const Controller at_stage = controller_;
    const ControllerOutput output_at_stage = output_;
    const climb_tests::LadderStand stand_at_stage = stand_;
    for (const FailsafeRow& row : failsafe_table()) {
      if (!failsafe(flag(row.fault), S::kClimbing).latched) continue;
      controller_ = at_stage;
      output_ = output_at_stage;
      stand_ = stand_at_stage;
      stand_.input.faults = flag(row.fault);
      cycle();
      EXPECT_EQ(output_.reason, row.fault) << name(stage);
      EXPECT_TRUE(is_latched(output_.state)) << row.name;
      EXPECT_EQ(output_.send, !row.silent && output_.state == S::kFaultHold) << row.name;
      for (int i = 0; i < 30; ++i) cycle();
      const PerAxis<AxisCommand> stood = output_.axes;
      for (int i = 0; i < 20; ++i) cycle();
      for (int axis = 0; axis < kNumAxes; ++axis) {
        if (axis % kNumAxesPerLeg == kJaw) continue;
        EXPECT_EQ(output_.axes[axis].position_rad, stood[axis].position_rad);
      }
      for (const Leg leg : kLegs) EXPECT_TRUE(leg == kRearRight || stand_.held(leg));
      EXPECT_EQ(output_.reason, row.fault);
    }
  }
}

// Without perception it stops before the reach and goes on by itself when it sees again.
TEST_F(ControllerTest, WaitsForPerception) {
  ASSERT_TRUE(arm()) << where();
  order(Order::kClimb);
  ASSERT_TRUE(reach_limb(kRearRight, LimbState::kTransit, 20.0));
  stand_.sees = false;
  ASSERT_TRUE(reach(S::kProtectiveHold, 0.32)) << where();
  EXPECT_EQ(output_.reason, Fault::kPerceptionSilent);
  stand_.sees = true;
  ASSERT_TRUE(reach(S::kClimbing, 0.05)) << where();
  ASSERT_TRUE(reach_limb(kRearRight, LimbState::kLoaded, 20.0)) << where();
}

// A target that disappears before commit: back to the rung it came from, then HOLD.
TEST_F(ControllerTest, ReturnsWhenTheTargetIsWithdrawn) {
  ASSERT_TRUE(arm()) << where();
  order(Order::kClimb);
  ASSERT_TRUE(reach_limb(kRearRight, LimbState::kTransit, 20.0));
  stand_.rungs[1].trusted = false;
  cycle();
  cycle();
  EXPECT_EQ(output_.limbs[kRearRight], LimbState::kAbortReturn) << where();
  ASSERT_TRUE(reach(S::kHold, 30.0)) << where();
  EXPECT_EQ(output_.limbs[kRearRight], LimbState::kLoaded);
  EXPECT_EQ(output_.rung_ids[kRearRight], 1);
}

// A target that is seen a little elsewhere by now is followed, not left.
TEST_F(ControllerTest, FollowsATargetThatMoves) {
  ASSERT_TRUE(arm()) << where();
  order(Order::kClimb);
  ASSERT_TRUE(reach_limb(kRearRight, LimbState::kTransit, 20.0));
  stand_.rungs[1].end0_m += Eigen::Vector3d(0.02, 0.0, 0.02);
  stand_.rungs[1].end1_m += Eigen::Vector3d(0.02, 0.0, 0.02);
  cycle();
  cycle();
  EXPECT_EQ(output_.limbs[kRearRight], LimbState::kTransit) << where();
  ASSERT_TRUE(reach_limb(kRearRight, LimbState::kLoaded, 20.0)) << where();
  EXPECT_EQ(output_.rung_ids[kRearRight], 2);
}

// A target that disappears for a moment: back to the old rung, and once more.
TEST_F(ControllerTest, TriesAgainWhenTheTargetComesBack) {
  ASSERT_TRUE(arm()) << where();
  order(Order::kClimb);
  ASSERT_TRUE(reach_limb(kRearRight, LimbState::kTransit, 20.0));
  stand_.rungs[1].damaged = true;
  ASSERT_TRUE(reach_limb(kRearRight, LimbState::kLoaded, 30.0)) << where();
  stand_.rungs[1].damaged = false;
  ASSERT_TRUE(reach_limb(kRearRight, LimbState::kTransit, 20.0)) << where();
  ASSERT_TRUE(reach_limb(kRearRight, LimbState::kLoaded, 30.0)) << where();
  EXPECT_EQ(output_.rung_ids[kRearRight], 2);
  EXPECT_EQ(output_.state, S::kClimbing);
}

// A target that comes and goes is left alone in the end.
TEST_F(ControllerTest, LeavesATargetThatComesAndGoes) {
  ASSERT_TRUE(arm()) << where();
  order(Order::kClimb);
  for (int i = 0; i < ControllerParams().max_withdrawn; ++i) {
    ASSERT_EQ(output_.state, S::kClimbing) << i << where();
    ASSERT_TRUE(reach_limb(kRearRight, LimbState::kTransit, 20.0)) << i << where();
    stand_.rungs[1].trusted = false;
    ASSERT_TRUE(reach_limb(kRearRight, LimbState::kLoaded, 30.0)) << i << where();
    stand_.rungs[1].trusted = true;
  }
  ASSERT_TRUE(reach(S::kHold, 1.0)) << where();
  EXPECT_EQ(output_.refusal, Refusal::kNotTrusted);
  EXPECT_EQ(output_.rung_ids[kRearRight], 1);
}

// A rung that breaks under a resting claw: the loss is latched and told, no other claw opens.
TEST_F(ControllerTest, LatchesALostStance) {
  ASSERT_TRUE(arm()) << where();
  order(Order::kClimb);
  ASSERT_TRUE(reach_limb(kRearRight, LimbState::kTransit, 20.0));
  stand_.break_rung(1);  // holds the rear left claw
  ASSERT_TRUE(reach(S::kFaultHold, 0.06)) << where();
  EXPECT_EQ(output_.limbs[kRearLeft], LimbState::kSupportLost);
  EXPECT_TRUE(stand_.held(kFrontLeft) && stand_.held(kFrontRight));
}

// A target rung that is not there: three tries, then back on the old rung; the others never open.
TEST_F(ControllerTest, TriesThreeTimesThenReturns) {
  ASSERT_TRUE(arm()) << where();
  order(Order::kClimb);
  stand_.break_rung(2);
  ASSERT_TRUE(reach_limb(kRearRight, LimbState::kAbortReturn, 30.0)) << where();
  ASSERT_TRUE(reach(S::kHold, 30.0)) << where();
  EXPECT_EQ(output_.rung_ids[kRearRight], 1) << where();
  for (const Leg leg : kLegs) EXPECT_TRUE(stand_.held(leg));
}

// Neither old nor new rung: the claw stays open, the fault is told.
TEST_F(ControllerTest, LatchesNoGrasp) {
  ASSERT_TRUE(arm()) << where();
  order(Order::kClimb);
  ASSERT_TRUE(reach_limb(kRearRight, LimbState::kTransit, 30.0)) << where();
  stand_.break_rung(2);
  ASSERT_TRUE(reach_limb(kRearRight, LimbState::kAbortReturn, 30.0)) << where();
  stand_.hide_rung(1, kRearRight);
  ASSERT_TRUE(reach(S::kFaultHold, 30.0)) << where();
  EXPECT_EQ(output_.reason, Fault::kNoGrasp);
}

// Hanging, it is disarmed only where something else than torque holds it.
TEST_F(ControllerTest, KeepsTorqueWhileItHangs) {
  climb_to(LimbState::kTransit);
  order(Order::kHold);
  ASSERT_TRUE(reach(S::kHold, 60.0)) << where();
  order(Order::kDisarm);
  EXPECT_EQ(output_.command, CommandVerdict::kNotNow);
  EXPECT_EQ(output_.state, S::kHold);

  ControllerParams braked = params();
  braked.power_off_holds = true;
  controller_ = Controller(braked);
  stand_ = climb_tests::LadderStand(params().climb);
  output_ = ControllerOutput();
  ASSERT_TRUE(arm()) << where();
  order(Order::kClimb);
  run(5.0);
  order(Order::kHold);
  ASSERT_TRUE(reach(S::kHold, 60.0)) << where();
  order(Order::kDisarm);
  EXPECT_EQ(output_.state, S::kDisarming);
  ASSERT_TRUE(reach(S::kDisarmed, 1.0)) << where();
  EXPECT_FALSE(stand_.input.drives_enabled);
}

// At random times random faults come and go, readings turn to garbage, orders are given: what is
// sent keeps invariant 2, never more than one limb moves, every stop has a reason (1 and 8).
TEST_F(ControllerTest, KeepsItsInvariantsInDisorder) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    base::Rng rng(seed);
    climb_tests::LadderStand stand(params().climb);
    Controller controller(params());
    std::swap(stand_, stand);
    std::swap(controller_, controller);
    output_ = ControllerOutput();
    ASSERT_TRUE(arm()) << where();
    for (int i = 0; i < 3000; ++i) {
      const double what = rng.uniform();
      if (what < 0.002) stand_.input.faults |= FaultFlags{1} << rng.below(kNumFaults);
      if (what > 0.99) stand_.input.faults = 0;
      if (what > 0.4 && what < 0.42)
        stand_.input.command = {static_cast<Order>(1 + rng.below(6)), kSession, ++seq_};
      if (what > 0.5 && what < 0.5005) {
        stand_.input.axes[rng.below(kNumAxes)].position_rad = climb_tests::kNan;
      }
      if (what > 0.6 && what < 0.6005) stand_.input.imu.q_odom_body.w() = climb_tests::kNan;
      const PerLeg<LimbState> before = output_.limbs;
      cycle();
      stand_.input.imu.q_odom_body = stand_.upright();
      if (is_latched(output_.state)) {
        ASSERT_NE(output_.reason, Fault::kNone) << "seed " << seed;
      }
      for (const Leg leg : kLegs) {
        const bool opens =
            output_.limbs[leg] == LimbState::kReleasing && before[leg] == LimbState::kUnloading;
        if (!opens) continue;
        for (const Leg other : kLegs) {
          ASSERT_TRUE(other == leg || is_confirmed(output_.limbs[other])) << "seed " << seed;
        }
      }
    }
  }
}

}  // namespace
}  // namespace climb
