// SPDX-License-Identifier: BSD-3-Clause
// Steps over a rung that is missing, or none to grasp: which body and which leg make room for them,
// how a foot passes the rung that is left out, and when there is no such step.
#include <gtest/gtest.h>

#include "tests/climb/controller_fixture.h"

namespace climb {
namespace {

using climb_tests::params;
using S = ControllerState;

class LongStepTest : public climb_tests::ControllerFixture {
 protected:
  void SetUp() override {
    start_anew();
    ASSERT_TRUE(arm()) << where();
  }
  RungView& rung(int id) { return stand_.rungs.at(static_cast<std::size_t>(id - 1)); }
  /// Climbs until it holds. Least distance of a foot in transit to this height of the ladder, out
  /// of its plane.
  void climb_past(double height_m) {
    order(Order::kClimb);
    for (int i = 0; i < 40'000 && output_.state != S::kHold; ++i) {
      cycle();
      for (const Leg leg : kLegs) {
        used_[leg] = used_[leg] || output_.rung_ids[leg] == left_out_;
        if (output_.limbs[leg] != LimbState::kTransit) continue;
        const Eigen::Vector3d foot_m =
            output_.pose.T_odom_body() * kinematics_.foot_m(leg, stand_.measured_rad(leg));
        if (std::abs(foot_m.z() - height_m) > 0.03) continue;
        const double out_m = params().climb.motion.stand_off_m - foot_m.x();
        least_out_m_ = std::min(least_out_m_, out_m);
        ++num_passing_;
      }
    }
    ASSERT_EQ(output_.state, S::kHold) << where();
  }
  bool is_any_used() const { return used_[0] || used_[1] || used_[2] || used_[3]; }

  LegKinematics kinematics_{params().climb.robot};
  int left_out_ = 6;
  PerLeg<bool> used_{};
  double least_out_m_ = 1.0;
  int num_passing_ = 0;
};

// A rung that looks damaged is left out by all four legs, which pass it well clear of the ladder;
// then the climb goes on to the top.
TEST_F(LongStepTest, StepsOverADamagedRung) {
  rung(6).damaged = true;
  climb_past(rung(6).end0_m.z());
  EXPECT_TRUE(output_.at_top) << where();
  EXPECT_FALSE(is_any_used());
  EXPECT_GT(num_passing_, 0);
  EXPECT_GE(least_out_m_, 0.09);
}

// So is one that is not there.
TEST_F(LongStepTest, StepsOverAMissingRung) {
  stand_.break_rung(6);
  stand_.rungs.erase(stand_.rungs.begin() + 5);
  stand_.stretches.pop_back();
  climb_past(1.2);
  EXPECT_TRUE(output_.at_top) << where();
}

// The rung above a gap may be out of sight from below it: the body rises and looks before it is
// told that this is the top.
TEST_F(LongStepTest, RisesToSeeWhatIsAboveAGap) {
  stand_.break_rung(6);
  stand_.rungs.erase(stand_.rungs.begin() + 5);
  stand_.stretches.pop_back();
  stand_.sees_up_m = 0.9;
  climb_past(1.2);
  EXPECT_TRUE(output_.at_top) << where();
  EXPECT_EQ(output_.rung_ids[kFrontLeft], 9);
}

// One that gives way in the pull test is tried in vain, left, and then stepped over.
TEST_F(LongStepTest, LeavesOutARungThatDoesNotHold) {
  stand_.break_rung(6);
  climb_past(rung(6).end0_m.z());
  EXPECT_TRUE(output_.at_top) << where();
  EXPECT_FALSE(is_any_used());
}

// Two rungs of which none may be grasped are too far for any step: it holds for that reason before
// anything is let go.
TEST_F(LongStepTest, HoldsBelowTwoOfThem) {
  rung(6).damaged = rung(7).damaged = true;
  climb_past(rung(6).end0_m.z());
  EXPECT_FALSE(output_.at_top);
  EXPECT_EQ(output_.refusal, Refusal::kDamaged) << where();
  EXPECT_EQ(num_passing_, 0);
}

// What is damaged at one moment and sound within two seconds is not stepped over.
TEST_F(LongStepTest, LooksAgainBeforeItLeavesARungOut) {
  rung(6).damaged = true;
  order(Order::kClimb);
  for (int i = 0; i < 20'000 && output_.refusal != Refusal::kDamaged; ++i) cycle();
  ASSERT_EQ(output_.refusal, Refusal::kDamaged) << where();
  run(1.5);
  ASSERT_EQ(output_.state, S::kClimbing);
  for (const Leg leg : kLegs) EXPECT_EQ(output_.limbs[leg], LimbState::kLoaded);
  rung(6).damaged = false;
  climb_past(rung(6).end0_m.z());
  EXPECT_TRUE(is_any_used());
}

// A wrong radius that passes within two seconds does not end the climb; one that stays does.
TEST_F(LongStepTest, LooksAgainAtAThickness) {
  for (RungView& each : stand_.rungs) each.radius_m = 0.009;
  order(Order::kClimb);
  run(1.5);
  ASSERT_EQ(output_.state, S::kClimbing) << where();
  EXPECT_EQ(output_.refusal, Refusal::kRadius);
  for (RungView& each : stand_.rungs) each.radius_m = 0.014;
  EXPECT_TRUE(reach_limb(kRearRight, LimbState::kTransit, 20.0)) << where();
  for (RungView& each : stand_.rungs) each.radius_m = 0.009;
  EXPECT_TRUE(reach(S::kHold, 20.0)) << where();
  EXPECT_EQ(output_.refusal, Refusal::kRadius) << where();
}

}  // namespace
}  // namespace climb
