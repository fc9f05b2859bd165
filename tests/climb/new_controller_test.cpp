// SPDX-License-Identifier: BSD-3-Clause
// A controller that was started anew while the robot hangs on its claws: it moves nothing unasked,
// finds out by feel what holds, opens nothing that does, and climbs on.
#include <gtest/gtest.h>

#include "tests/climb/controller_fixture.h"

namespace climb {
namespace {

using climb_tests::kSession;
using climb_tests::params;
using S = ControllerState;

class NewControllerTest : public climb_tests::ControllerFixture {
 protected:
  /// The old one is gone; the drives have stopped and hold by themselves.
  void replace_controller() {
    controller_ = Controller(params());
    output_ = ControllerOutput();
    stand_.input.drives_enabled = false;
    stand_.begin_odom_here();
    seq_ = 0;
  }
  int num_held() const {
    int num = 0;
    for (const Leg leg : kLegs) num += stand_.held(leg) ? 1 : 0;
    return num;
  }
  int num_proven() const {
    int num = 0;
    for (const Leg leg : kLegs) {
      const LimbCycle& limb = controller_.limb(leg);
      num += is_confirmed(limb.state()) && !limb.needs_proof() ? 1 : 0;
    }
    return num;
  }
  /// Armed by command. No claw that holds opens while fewer than three others are proven.
  bool arms_without_letting_go(double within_s) {
    if (!reach(S::kDisarmed, 1.0)) return false;
    for (int i = 0; i < 100; ++i) {
      cycle();
      EXPECT_FALSE(output_.send || output_.state != S::kDisarmed) << where();
    }
    order(Order::kArm);
    for (int i = 0; i < static_cast<int>(100.0 * within_s); ++i) {
      if (output_.state == S::kHold || is_latched(output_.state)) break;
      const PerLeg<bool> held = {stand_.held(kFrontLeft), stand_.held(kFrontRight),
                                 stand_.held(kRearLeft), stand_.held(kRearRight)};
      const int num_proven_before = num_proven();
      cycle();
      for (const Leg leg : kLegs) {
        if (!held[leg] || stand_.held(leg)) continue;
        EXPECT_GE(num_proven_before, 3) << name(leg) << " let go " << where();
      }
    }
    return output_.state == S::kHold;
  }
};

// Replaced in any stage of a step: the new one touches nothing until armed; then it has pulled at
// every claw, four hold, and it climbs to the top.
TEST_F(NewControllerTest, TakesOverOnTheLadder) {
  for (const LimbState stage :
       {LimbState::kLoaded, LimbState::kUnloading, LimbState::kReleasing, LimbState::kRetracting,
        LimbState::kTransit, LimbState::kPregrasp, LimbState::kApproach, LimbState::kClosing,
        LimbState::kVerify, LimbState::kLoading}) {
    climb_to(stage);
    replace_controller();
    ASSERT_TRUE(arms_without_letting_go(60.0)) << name(stage) << where();
    EXPECT_EQ(num_held(), kNumLegs) << name(stage);
    EXPECT_EQ(num_proven(), kNumLegs) << name(stage);
    for (const Leg leg : kLegs) {
      EXPECT_TRUE(controller_.limb(leg).last_witness().all()) << name(leg) << name(stage);
    }
    order(Order::kClimb);
    ASSERT_TRUE(reach(S::kHold, 400.0)) << name(stage) << where();
    EXPECT_TRUE(output_.at_top) << name(stage) << where();
  }
}

// And in the body shift, and after each of the four first steps: whose turn it is, the feet tell.
TEST_F(NewControllerTest, FindsWhoseTurnItIs) {
  for (int num_steps = 1; num_steps <= kNumLegs; ++num_steps) {
    start_anew();
    ASSERT_TRUE(arm());
    order(Order::kClimb);
    for (int step = 0; step < num_steps; ++step) {
      const Leg leg = step == 0   ? kRearRight
                      : step == 1 ? kFrontRight
                      : step == 2 ? kRearLeft
                                  : kFrontLeft;
      ASSERT_TRUE(reach_limb(leg, LimbState::kTransit, 30.0)) << where();
      ASSERT_TRUE(reach_limb(leg, LimbState::kLoaded, 30.0)) << where();
    }
    run(0.3);
    replace_controller();
    ASSERT_TRUE(arms_without_letting_go(60.0)) << num_steps << where();
    order(Order::kClimb);
    ASSERT_TRUE(reach(S::kHold, 400.0)) << num_steps << where();
    EXPECT_TRUE(output_.at_top) << num_steps << where();
  }
}

// A jaw that stands as if it held, and closes on nothing: a free limb, that grasps anew.
TEST_F(NewControllerTest, AClawRoundNothingGraspsAnew) {
  ASSERT_TRUE(arm());
  stand_.drop(kRearLeft);
  replace_controller();
  stand_.mend_rungs();
  ASSERT_TRUE(arms_without_letting_go(60.0)) << where();
  EXPECT_EQ(num_held(), kNumLegs) << where();
  EXPECT_EQ(num_proven(), kNumLegs);
}

// One claw gives way when it is pulled at: it stays closed, and is told. Ordered again, with the
// three others proven, it grasps anew.
TEST_F(NewControllerTest, ADoubtfulClawStaysClosedUntilOrderedAgain) {
  ASSERT_TRUE(arm());
  replace_controller();
  stand_.stiffness_part[kFrontLeft] = 0.02;
  ASSERT_FALSE(arms_without_letting_go(60.0)) << where();
  EXPECT_EQ(output_.state, S::kFaultHold);
  EXPECT_EQ(output_.reason, Fault::kNoGrasp) << where();
  EXPECT_EQ(num_held(), kNumLegs);
  EXPECT_EQ(num_proven(), 3);
  stand_.stiffness_part[kFrontLeft] = 1.0;
  run(0.5);
  order(Order::kReset);
  ASSERT_TRUE(arms_without_letting_go(60.0)) << where();
  EXPECT_EQ(num_proven(), kNumLegs);
}

// Two that give way: nothing is opened, however often it is ordered; people must help.
TEST_F(NewControllerTest, TwoDoubtfulClawsStayClosed) {
  ASSERT_TRUE(arm());
  replace_controller();
  stand_.stiffness_part[kFrontLeft] = stand_.stiffness_part[kRearLeft] = 0.02;
  for (int i = 0; i < 2; ++i) {
    ASSERT_FALSE(arms_without_letting_go(60.0)) << where();
    EXPECT_EQ(output_.state, S::kFaultHold);
    EXPECT_EQ(output_.reason, Fault::kNoGrasp) << where();
    EXPECT_EQ(num_held(), kNumLegs);
    run(0.5);
    order(Order::kReset);
  }
}

// Closed claws are adopted by feel: nothing needs to be seen for it.
TEST_F(NewControllerTest, AdoptsBlindly) {
  ASSERT_TRUE(arm());
  replace_controller();
  stand_.sees = false;
  ASSERT_TRUE(arms_without_letting_go(60.0)) << where();
  EXPECT_EQ(num_proven(), kNumLegs);
}

// A free limb below which no rung is trusted takes the one that the other of its pair holds.
TEST_F(NewControllerTest, AFreeLimbFindsTheRungBesideIt) {
  climb_to(LimbState::kTransit);
  replace_controller();
  for (RungView& rung : stand_.rungs) rung.trusted = false;
  ASSERT_TRUE(arms_without_letting_go(60.0)) << where();
  EXPECT_EQ(num_held(), kNumLegs) << where();
  for (const Leg leg : kLegs) EXPECT_EQ(output_.rung_ids[leg], -1) << "felt rungs have no number";
}

// Not one that looks damaged: then arming tells why, ends, and everything stays as it is.
TEST_F(NewControllerTest, ArmingThatFindsNoRungTellsWhyAndEnds) {
  climb_to(LimbState::kTransit);
  replace_controller();
  for (RungView& rung : stand_.rungs) rung.damaged = true;
  ASSERT_TRUE(reach(S::kDisarmed, 1.0));
  order(Order::kArm);
  run(60.0);
  EXPECT_EQ(output_.state, S::kArming) << where();
  EXPECT_EQ(output_.refusal, Refusal::kDamaged) << where();
  ASSERT_TRUE(reach(S::kDisarmed, 70.0)) << where();
  EXPECT_EQ(output_.refusal, Refusal::kDamaged) << where();
  EXPECT_EQ(num_held(), 3);
}

// Stopped again while it takes over, and armed again: the same care, the same end.
TEST_F(NewControllerTest, IsStoppedWhileItTakesOver) {
  for (const LimbState stage : {LimbState::kVerify, LimbState::kLoading}) {
    start_anew();
    ASSERT_TRUE(arm());
    replace_controller();
    ASSERT_TRUE(reach(S::kDisarmed, 1.0));
    order(Order::kArm);
    ASSERT_TRUE(reach_limb(kFrontRight, stage, 30.0)) << name(stage) << where();
    stand_.input.estop_clear = false;
    cycle();
    ASSERT_EQ(output_.state, S::kEstop);
    stand_.input.estop_clear = true;
    run(1.0);
    order(Order::kReset);
    ASSERT_TRUE(arms_without_letting_go(60.0)) << name(stage) << where();
    EXPECT_EQ(num_proven(), kNumLegs);
  }
}

}  // namespace
}  // namespace climb
