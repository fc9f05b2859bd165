// SPDX-License-Identifier: BSD-3-Clause
// The search for a grasp: a little aside, elsewhere on the rung, another rung, back to the old one,
// and the end of it; every state of a limb ends in bounded time.
#include <gtest/gtest.h>

#include "tests/climb/controller_fixture.h"

namespace climb {
namespace {

using climb_tests::params;
using S = ControllerState;

class RegraspTest : public climb_tests::ControllerFixture {
 protected:
  /// Runs until the rear right limb has left the air; where its claw closed, in order.
  std::vector<LimbGoal> search(double& seconds) {
    std::vector<LimbGoal> places;
    LimbState before = output_.limbs[kRearRight];
    seconds = 0.0;
    while (output_.state == S::kClimbing && seconds < 120.0) {
      cycle();
      seconds += 0.01;
      const LimbState at = output_.limbs[kRearRight];
      if (at == LimbState::kClosing && before != at) {
        places.push_back(controller_.limb(kRearRight).goal());
      }
      before = at;
    }
    return places;
  }
  /// Through VERIFY; the most that the rear right foot pulled, N.
  double pull() {
    double most_N = 0.0;
    const LegKinematics kinematics(params().climb.robot);
    PerLeg<LegAngles> before;
    for (int joint = 0; joint < kNumLegJoints; ++joint)
      before[kRearRight][joint] = stand_.input.axes[axis_of(kRearRight, joint)].torque_Nm;
    while (output_.limbs[kRearRight] == LimbState::kVerify) {
      LegAngles torque_Nm;
      for (int joint = 0; joint < kNumLegJoints; ++joint)
        torque_Nm[joint] = stand_.input.axes[axis_of(kRearRight, joint)].torque_Nm;
      const Eigen::Matrix3d J = kinematics.jacobian(kRearRight, stand_.measured_rad(kRearRight));
      most_N =
          std::max(most_N, (J.transpose().inverse() * (torque_Nm - before[kRearRight])).norm());
      cycle();
    }
    return most_N;
  }
};

// Three tries at the first place, one elsewhere on the same rung at least a claw's width aside,
// then back; the whole search takes no longer than its budget and the way back.
TEST_F(RegraspTest, TriesElsewhereOnTheRungThenReturns) {
  climb_to(LimbState::kUnloading);
  stand_.break_rung(2);
  double seconds = 0.0;
  const std::vector<LimbGoal> places = search(seconds);
  ASSERT_GE(places.size(), 5U);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(places[i].rung_id, 2) << i;
  EXPECT_EQ(places[2].grasp_m, places[0].grasp_m);
  EXPECT_GE((places[3].grasp_m - places[0].grasp_m).norm(), 0.0349);
  EXPECT_EQ(places.back().rung_id, 1);
  EXPECT_EQ(output_.state, S::kHold) << where();
  EXPECT_EQ(output_.refusal, Refusal::kAvoided);
  EXPECT_EQ(output_.rung_ids[kRearRight], 1);
  EXPECT_LE(seconds, 20.0 + 10.0);
}

// Where two rungs are within a step, the farther one is taken when the nearer one does not hold.
TEST_F(RegraspTest, TakesAnotherRung) {
  climb_to(LimbState::kUnloading);
  stand_.add_rung_at(2.45);
  stand_.break_rung(2);
  ASSERT_TRUE(reach_limb(kRearRight, LimbState::kLoaded, 40.0)) << where();
  EXPECT_EQ(output_.rung_ids[kRearRight], 10) << where();
  EXPECT_EQ(output_.state, S::kClimbing);
}

// The rung that failed is the next one to be tried again when climbing is ordered again: the limb
// that returned is not passed over.
TEST_F(RegraspTest, TheReturnedLimbGoesNext) {
  climb_to(LimbState::kTransit);
  stand_.break_rung(2);
  ASSERT_TRUE(reach(S::kHold, 60.0)) << where();
  stand_.mend_rungs();
  order(Order::kClimb);
  ASSERT_TRUE(reach_limb(kRearRight, LimbState::kTransit, 20.0)) << where();
  EXPECT_EQ(output_.limbs[kFrontRight], LimbState::kLoaded);
}

// A claw that never closes ends each try after 2 s, and the search after 20 s: in FAULT_HOLD, as it
// does not close on the old rung either.
TEST_F(RegraspTest, BudgetEndsTheSearch) {
  climb_to(LimbState::kTransit);
  stand_.stuck_jaw_rad[kRearRight] = 1.2;
  double seconds = 0.0;
  search(seconds);
  EXPECT_EQ(output_.state, S::kFaultHold) << where();
  EXPECT_EQ(output_.reason, Fault::kNoGrasp);
  EXPECT_LE(seconds, 2.0 * 20.0 + 5.0);
}

// A jaw that sticks closed, half open, or wherever: no limb state lasts for ever, and it ends with
// all claws loaded or in FAULT_HOLD.
TEST_F(RegraspTest, NoStateLastsForEver) {
  for (const LimbState stage :
       {LimbState::kUnloading, LimbState::kReleasing, LimbState::kRetracting, LimbState::kTransit,
        LimbState::kPregrasp, LimbState::kApproach, LimbState::kClosing, LimbState::kVerify,
        LimbState::kLoading}) {
    for (const double stuck_rad : {-0.6, -0.44, 0.0, 0.6, 1.0, 1.2}) {
      climb_to(stage);
      stand_.stuck_jaw_rad[kRearRight] = stuck_rad;
      order(Order::kHold);
      double since_s = 0.0;
      LimbState before = output_.limbs[kRearRight];
      for (int i = 0; i < 12'000 && output_.state == S::kClimbing; ++i) {
        cycle();
        since_s = output_.limbs[kRearRight] == before ? since_s + 0.01 : 0.0;
        before = output_.limbs[kRearRight];
        if (before != LimbState::kLoaded) {
          ASSERT_LE(since_s, 5.0) << name(before) << stuck_rad;
        }
      }
      EXPECT_NE(output_.state, S::kClimbing) << name(stage) << " " << stuck_rad << where();
    }
  }
}

// A jaw that does not open closes again on its rung: the climb ends in HOLD with four claws on.
TEST_F(RegraspTest, AJawThatDoesNotOpenHolds) {
  climb_to(LimbState::kUnloading);
  stand_.stuck_jaw_rad[kRearRight] = params().climb.robot.claw.on_rung_rad;
  ASSERT_TRUE(reach(S::kHold, 20.0)) << where();
  for (const Leg leg : kLegs) EXPECT_EQ(output_.limbs[leg], LimbState::kLoaded);
}

// The pull test ends at the force that a claw is meant to bear (100 N), however stiff the rung;
// what the closed jaw still draws the other way when it begins (20 N at most) is overcome first.
TEST_F(RegraspTest, PullsNoHarderThanItMay) {
  climb_to(LimbState::kVerify);
  const double most_N = pull();
  EXPECT_EQ(output_.limbs[kRearRight], LimbState::kLoading);
  EXPECT_GE(most_N, 40.0);
  EXPECT_LE(most_N, 125.0);
}

// A leg so soft that 10 mm fall short of 40 N is pulled up to 4 mm further; one that falls short
// then too has no grasp. At a fifth of the stand's stiffness 10 mm give 40 N.
TEST_F(RegraspTest, PullsASoftLegFurther) {
  const auto after_pull = [this](double part) {
    climb_to(LimbState::kVerify);
    stand_.stiffness_Nm_rad *= part;
    pull();
    return output_.limbs[kRearRight];
  };
  EXPECT_EQ(after_pull(0.25), LimbState::kLoading);
  EXPECT_EQ(after_pull(0.16), LimbState::kLoading);
  EXPECT_EQ(after_pull(0.11), LimbState::kRegrasp);
}

}  // namespace
}  // namespace climb
