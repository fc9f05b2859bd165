// SPDX-License-Identifier: BSD-3-Clause
// The real controller and the real CAN master on the robot in physics: it hangs, climbs to the top
// on rungs that perception sees wrongly, comes down into the dock, and stays on the ladder when a
// rung breaks, all with claws that hold by contact.
#include <gtest/gtest.h>

#include "robot_in_a_box/physical_climb.h"

namespace robot_in_a_box {
namespace {

using climb::ControllerState;

PhysicalClimbParams ladder(int num_rungs, double spacing_m = 0.30) {
  PhysicalClimbParams params;
  params.scene.num_rungs = num_rungs;
  params.scene.spacing_m = spacing_m;
  params.scene.seed = params.seed = 2;
  params.perception.bias_m = 0.005;
  params.perception.jitter_m = 0.003;
  params.perception.tilt_rad = 0.017;
  return params;
}

void expect_no_violation(const PhysicalClimb& climb) {
  for (const simulator::Violation& violation : climb.box().monitor().violations()) {
    ADD_FAILURE() << describe(violation);
  }
}

/// Released from the dock the robot hangs on four claws: it sags by the claws' clearance at most,
/// and what the claws put on the rungs is its weight.
TEST(PhysicalClimb, HangsOnFourClaws) {
  PhysicalClimb climb(ladder(5));
  const double docked_m = climb.height_m();
  ASSERT_TRUE(climb.hang()) << climb.reason();
  EXPECT_EQ(climb.num_held(), simulator::kNumLegs);
  EXPECT_LT(docked_m - climb.height_m(), 0.015);
  double down_N = 0.0;
  for (int leg = 0; leg < simulator::kNumLegs; ++leg) {
    down_N -= climb.box().plant().leg(leg).force_on_rung_N.z();
  }
  EXPECT_NEAR(down_N, 9.81 * mj_getTotalmass(&climb.model().model()), 5.0);
}

/// The jaw stands where the rung's thickness has it: thin and thick ones are grasped, nothing
/// fails.
TEST(PhysicalClimb, HangsOnThinAndThickRungs) {
  for (const double diameter_m : {0.024, 0.030, 0.036}) {
    PhysicalClimbParams params = ladder(5);
    params.scene.rung_diameter_m = diameter_m;
    PhysicalClimb climb(params);
    EXPECT_TRUE(climb.hang()) << diameter_m << ' ' << climb.reason();
    EXPECT_EQ(climb.figures().grasps_failed, 0) << diameter_m;
  }
}

/// Rungs seen 5 mm, another 3 mm in each message and 1 degree off are climbed to the top, with
/// three claws on rungs all the time and no drive at its limit; and down again into the dock.
TEST(PhysicalClimb, ClimbsToTheTopAndBackIntoTheDock) {
  PhysicalClimb climb(ladder(5));
  ASSERT_TRUE(climb.hang()) << climb.reason();
  ASSERT_EQ(climb.climb(true, 120.0), ClimbEnd::kTop) << climb.reason();
  const simulator::Figures& figures = climb.figures();
  EXPECT_EQ(figures.rungs_climbed, 2);
  EXPECT_EQ(figures.falls, 0);
  EXPECT_GE(figures.min_support, 3);
  EXPECT_LT(figures.peak_joint_torque_Nm, 30.0);
  EXPECT_LT(figures.peak_grip_N, 186.0);  // tears a claw off
  EXPECT_LT(figures.pose_drift_mm, 10.0);
  ASSERT_EQ(climb.climb(false, 180.0), ClimbEnd::kDock) << climb.reason();
  EXPECT_TRUE(climb.back_into_dock()) << climb.reason();
  EXPECT_EQ(figures.falls, 0);
  EXPECT_GE(figures.min_support, 3);
  expect_no_violation(climb);
}

/// Ordered to disarm where no dock has come, it notices and goes on holding.
TEST(PhysicalClimb, DoesNotLetGoWithoutTheDock) {
  PhysicalClimb climb(ladder(5));
  ASSERT_TRUE(climb.hang()) << climb.reason();
  const double before_m = climb.height_m();
  climb.box().order(climb::Order::kDisarm);
  climb.run_s(3.0);
  EXPECT_EQ(climb.box().state(), ControllerState::kHold) << climb.reason();
  EXPECT_EQ(climb.num_held(), simulator::kNumLegs);
  EXPECT_LT(before_m - climb.height_m(), 0.012);
}

struct Break {
  double spacing_m;
  int leg;
};

class RungBreaksAtRest : public ::testing::TestWithParam<Break> {};

/// In the stance that it rests in, any one rung may break: it stays on the ladder with three claws
/// and says why it stopped.
TEST_P(RungBreaksAtRest, WithoutAFall) {
  PhysicalClimb climb(ladder(6, GetParam().spacing_m));
  ASSERT_TRUE(climb.hang()) << climb.reason();
  climb.box().order(climb::Order::kClimb);
  climb.run_s(1.0);
  climb.box().order(climb::Order::kHold);
  ASSERT_TRUE(climb.reach(ControllerState::kHold, 60.0)) << climb.reason();
  ASSERT_TRUE(climb.box().report().output.rests_safely);
  const int rung = climb.box().plant().leg(GetParam().leg).rung_index;
  ASSERT_GE(rung, 0);
  const double before_m = climb.height_m();
  climb.box().plant().world().rung(rung).break_at_us = climb.box().now_us();
  climb.run_s(3.0);
  EXPECT_EQ(climb.figures().falls, 0);
  EXPECT_EQ(climb.num_held(), 3);
  EXPECT_EQ(climb.box().state(), ControllerState::kFaultHold);
  EXPECT_EQ(climb.reason(), "stance lost");
  EXPECT_LT(before_m - climb.height_m(), 0.05);
}

INSTANTIATE_TEST_SUITE_P(EachRung, RungBreaksAtRest,
                         ::testing::Values(Break{0.30, 0}, Break{0.30, 1}, Break{0.30, 2},
                                           Break{0.30, 3}, Break{0.25, 0}, Break{0.25, 2},
                                           Break{0.34, 1}, Break{0.34, 3}));

/// A rung that breaks at less than a pull test asks of it is found out by that test and stepped
/// over: no fall, never fewer than three claws, both front claws on the topmost rung in the end.
TEST(PhysicalClimb, AWeakRungIsFoundOut) {
  PhysicalClimbParams params = ladder(7);
  params.weak_rungs = {{4, 40.0}};
  PhysicalClimb climb(params);
  ASSERT_TRUE(climb.hang()) << climb.reason();
  const ClimbEnd end = climb.climb(true, 200.0);
  EXPECT_EQ(end, ClimbEnd::kTop) << name(end) << ": " << climb.reason();
  for (const climb::Leg leg : {climb::kFrontLeft, climb::kFrontRight}) {
    EXPECT_EQ(climb.box().plant().leg(leg).rung_index, 6) << climb::name(leg);
  }
  EXPECT_TRUE(climb.box().plant().world().rung(4).broken);
  EXPECT_GE(climb.figures().min_support, 3);
  expect_no_violation(climb);
}

}  // namespace
}  // namespace robot_in_a_box
