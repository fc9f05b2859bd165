// SPDX-License-Identifier: BSD-3-Clause
// The rungs that a robot came up on, by which it comes down: what is offered of them, how far what
// is seen counts beside them, and what happens when odometry has drifted since.
#include "climb/way_back.h"

#include <limits>

#include <gtest/gtest.h>

#include "tests/climb/controller_fixture.h"

namespace climb {
namespace {

using climb_tests::params;
using S = ControllerState;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

LimbGoal place(double side_m, double height_m, double radius_m = 0.014) {
  LimbGoal goal;
  goal.grasp_m = {0.22, side_m, height_m};
  goal.radius_m = radius_m;
  return goal;
}

RungView seen_at(double height_m) {
  RungView rung;
  rung.id = 7;
  rung.trusted = true;
  rung.confidence = 1.0;
  rung.radius_m = 0.014;
  rung.end0_m = {0.22, -0.2, height_m};
  rung.end1_m = {0.22, 0.2, height_m};
  return rung;
}

class WayBackTest : public testing::Test {
 protected:
  LadderView look(std::span<const RungView> rungs = {}, bool confirmed = false) {
    stretches_.clear();
    for (int i = 0; i < static_cast<int>(rungs.size()); ++i) stretches_.push_back({i, 0.0, 0.4});
    way_.look({rungs, stretches_, 0.1, confirmed});
    return way_.view();
  }
  ClimbParams params_ = params().climb;
  WayBack way_{params_};
  std::vector<StretchView> stretches_;
};

// Where nothing was left, there is what is seen and nothing else.
TEST_F(WayBackTest, WithoutAWayThereIsWhatIsSeen) {
  EXPECT_FALSE(look().confirmed);
  EXPECT_TRUE(look().rungs.empty());
  const RungView seen = seen_at(0.9);
  const LadderView view = look(std::span(&seen, 1), true);
  ASSERT_EQ(view.rungs.size(), 1U);
  EXPECT_EQ(view.rungs[0].id, 7);
  ASSERT_EQ(view.stretches.size(), 1U);
  EXPECT_TRUE(view.confirmed);
  EXPECT_EQ(view.age_s, 0.1);
}

// A rung that was left is offered unseen, just where the claw was: the choice finds that place.
TEST_F(WayBackTest, OffersThePlaceThatWasLeft) {
  way_.leave(kRearLeft, place(0.15, -0.6));
  const LadderView view = look();
  ASSERT_EQ(view.rungs.size(), 1U);
  ASSERT_EQ(view.stretches.size(), 1U);
  const RungView& rung = view.rungs[0];
  EXPECT_TRUE(rung.trusted && !rung.damaged);
  EXPECT_GE(rung.id, WayBack::kFirstId);
  const StretchView& stretch = view.stretches[0];
  const Eigen::Vector3d axis = (rung.end1_m - rung.end0_m).normalized();
  const double spare_m = 0.5 * (stretch.to_m - stretch.from_m) - 0.5 * params_.robot.claw.width_m -
                         params_.grasp.claw_margin_m;
  EXPECT_GE(spare_m, 0.0);
  EXPECT_LE(spare_m, 0.003);
  const Eigen::Vector3d middle_m = rung.end0_m + 0.5 * (stretch.from_m + stretch.to_m) * axis;
  EXPECT_LE((middle_m - Eigen::Vector3d(0.22, 0.15, -0.6)).norm(), 1e-9);
}

// Two claws on one rung make one rung, whose axis goes through both places; in whichever order.
TEST_F(WayBackTest, TwoPlacesMakeOneRung) {
  for (const bool left_first : {true, false}) {
    way_.clear();
    if (left_first) way_.leave(kFrontLeft, place(0.16, 0.31));
    way_.leave(kFrontRight, place(-0.16, 0.30));
    if (!left_first) way_.leave(kFrontLeft, place(0.16, 0.31));
    way_.leave(kRearLeft, place(0.16, 0.31));  // the same place again
    const LadderView view = look();
    ASSERT_EQ(view.rungs.size(), 1U);
    ASSERT_EQ(view.stretches.size(), 2U);
    const RungView& rung = view.rungs[0];
    const Eigen::Vector3d axis = (rung.end1_m - rung.end0_m).normalized();
    EXPECT_NEAR(axis.z(), 0.01 / 0.32, 1e-3);
    for (const StretchView& stretch : view.stretches) {
      EXPECT_GE(stretch.from_m, -1e-9);
      EXPECT_LE(stretch.to_m, (rung.end1_m - rung.end0_m).norm() + 1e-9);
    }
  }
}

// What is seen of a rung that bore a claw does not count, whatever it says: own legs are before it.
// Others stay, with their own stretches.
TEST_F(WayBackTest, WhatBoreIsNotJudgedByItsLooks) {
  way_.leave(kRearLeft, place(0.15, -0.6));
  std::vector<RungView> seen = {seen_at(-0.58), seen_at(0.0)};
  seen[0].damaged = true;
  const LadderView view = look(seen, true);
  ASSERT_EQ(view.rungs.size(), 2U);
  EXPECT_FALSE(view.rungs[0].damaged);
  EXPECT_EQ(view.rungs[1].id, 7);
  ASSERT_EQ(view.stretches.size(), 2U);
  EXPECT_EQ(view.stretches[1].rung_index, 1);
}

// By as much as claws find a rung off, all others are shown off; a rung that is none of them
// teaches nothing.
TEST_F(WayBackTest, FollowsTheDriftOfOdometry) {
  way_.leave(kRearLeft, place(0.15, 0.0));
  way_.leave(kRearLeft, place(0.15, 0.3));
  const Eigen::Vector3d drift_m(0.004, 0.002, 0.03);
  for (int i = 0; i < 6; ++i) {
    way_.return_to(kRearLeft, Eigen::Vector3d(0.22, 0.15, 0.3) + drift_m);
    way_.return_to(kRearLeft, Eigen::Vector3d(0.22, 0.15, 0.3) + 10.0 * drift_m);
    way_.return_to(kRearRight, Eigen::Vector3d(0.22, -0.15, 0.3));
    way_.return_to(kRearLeft, Eigen::Vector3d(0.22, 0.15, kNaN));
  }
  const LadderView view = look();
  ASSERT_EQ(view.rungs.size(), 2U);
  EXPECT_NEAR(view.rungs[0].end0_m.z(), 0.03, 0.001);
  EXPECT_NEAR(view.rungs[1].end0_m.z(), 0.33, 0.001);
  // What is left from now on is told where it is now.
  way_.leave(kRearLeft, place(0.15, 0.63));
  EXPECT_NEAR(look().rungs[2].end0_m.z(), 0.63, 1e-9);
}

// Of very many the lowest are forgotten, and places that are no numbers are none.
TEST_F(WayBackTest, KeepsBoundsAndRefusesNoNumbers) {
  way_.leave(kRearLeft, place(0.15, kNaN));
  EXPECT_EQ(way_.num_rungs(), 0);
  const int num = static_cast<int>(WayBack::kMaxRungs) + 3;
  for (int i = 0; i < num; ++i) way_.leave(kRearLeft, place(0.15, 0.3 * i, 0.0));
  std::vector<RungView> many(WayBack::kMaxSeen + 10, seen_at(-5.0));
  many[0].end0_m.x() = kNaN;
  const LadderView view = look(many, true);
  ASSERT_EQ(view.rungs.size(), WayBack::kMaxRungs + WayBack::kMaxSeen);
  EXPECT_NEAR(view.rungs[0].end0_m.z(), 0.9, 1e-9);
  EXPECT_GT(view.rungs[0].radius_m, 0.01);
}

class WayDownTest : public climb_tests::ControllerFixture {
 protected:
  void SetUp() override {
    start_anew();
    ASSERT_TRUE(arm()) << where();
    order(Order::kClimb);
    ASSERT_TRUE(reach(S::kHold, 400.0)) << where();
    ASSERT_TRUE(output_.at_top) << where();
  }
  bool all_hold() const {
    return std::all_of(kLegs.begin(), kLegs.end(),
                       [&](Leg leg) { return output_.limbs[leg] == LimbState::kLoaded; });
  }
};

// From the top it comes back into the dock though every rung looks damaged from above.
TEST_F(WayDownTest, ComesDownByWhatItHasHeld) {
  for (RungView& rung : stand_.rungs) rung.damaged = true;
  order(Order::kClimbDown);
  ASSERT_TRUE(reach(S::kHold, 400.0)) << where();
  EXPECT_TRUE(output_.at_dock) << where();
  order(Order::kDisarm);
  EXPECT_TRUE(reach(S::kDisarmed, 60.0)) << where();
}

// An open jaw reaches 45 mm out and 60 mm down: a claw does not come straight down onto its rung
// but from before it.
TEST_F(WayDownTest, ComesToARungFromBefore) {
  constexpr double kLeast_m = 0.04, kMost_m = 0.08;  // above it: there the jaw would strike
  const LegKinematics kinematics{params().climb.robot};
  order(Order::kClimbDown);
  double least_out_m = 1.0;
  for (int i = 0; i < 40'000 && output_.state != S::kHold; ++i) {
    cycle();
    for (const Leg leg : kLegs) {
      if (output_.limbs[leg] != LimbState::kTransit) continue;
      const Eigen::Vector3d foot_m =
          output_.pose.T_odom_body() * kinematics.foot_m(leg, stand_.measured_rad(leg));
      for (const RungView& rung : stand_.rungs) {
        const double above_m = foot_m.z() - rung.end0_m.z();
        if (above_m < kLeast_m || above_m > kMost_m) continue;
        least_out_m = std::min(least_out_m, rung.end0_m.x() - foot_m.x());
      }
    }
  }
  EXPECT_TRUE(output_.at_dock) << where();
  EXPECT_GT(least_out_m, 0.07);
}

// A rung that broke meanwhile is found out by the claw: all four hold in the end, and it is told.
TEST_F(WayDownTest, ARungThatBrokeMeanwhileIsFoundOut) {
  stand_.break_rung(5);
  order(Order::kClimbDown);
  ASSERT_TRUE(reach(S::kHold, 600.0)) << where();
  EXPECT_TRUE(all_hold()) << where();
  EXPECT_TRUE(output_.at_dock || output_.refusal != Refusal::kNone) << where();
  EXPECT_FALSE(output_.fall_alarm);
}

// Up again from half way: the way is the one that is seen.
TEST_F(WayDownTest, GoesUpAgainByWhatItSees) {
  order(Order::kClimbDown);
  run(40.0);
  order(Order::kHold);
  ASSERT_TRUE(reach(S::kHold, 60.0)) << where();
  EXPECT_FALSE(output_.at_top);
  order(Order::kClimb);
  ASSERT_TRUE(reach(S::kHold, 400.0)) << where();
  EXPECT_TRUE(output_.at_top) << where();
  for (const Leg leg : kLegs) EXPECT_LT(output_.rung_ids[leg], WayBack::kFirstId);
}

}  // namespace
}  // namespace climb
