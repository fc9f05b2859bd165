// SPDX-License-Identifier: BSD-3-Clause
// Four witnesses of a grasp, one lying at a time.
#include "climb/grasp_confirmation.h"

#include <gtest/gtest.h>

#include "tests/climb/robot_poses.h"

namespace climb {
namespace {

using climb_tests::kInfinity;
using climb_tests::kNan;

constexpr double kCycle_s = 0.01;
const ClawParams kClaw;
const ClawReading kHeld = {true, kClaw.on_rung_rad, -3.2};
const ClawReading kEmpty = {false, kClaw.closed_rad, -6.0};
const ClawReading kOpen = {false, kClaw.open_rad, 0.0};
const PullResult kFirm = {0.0005, 65.0};

class Confirmation : public testing::Test {
 protected:
  void show(const ClawReading& reading, int num_cycles) {
    for (int i = 0; i < num_cycles; ++i) claw_.update(reading, kCycle_s);
  }
  GraspConfirmation claw_{kClaw, MotionParams(), ConfirmationParams()};
};

// All four agree: confirmed.
TEST_F(Confirmation, NeedsAllFour) {
  show(kHeld, 3);
  EXPECT_TRUE(claw_.conclude(kFirm).all());
  EXPECT_EQ(claw_.num_disagreements(), 0);
}

// Touch counts after 30 ms of level: 20 ms are not enough, a bounce begins anew.
TEST_F(Confirmation, WaitsForTheTouch) {
  show(kHeld, 2);
  EXPECT_FALSE(claw_.witness().touch);
  show(kOpen, 1);
  show(kHeld, 2);
  EXPECT_FALSE(claw_.witness().touch);
  show(kHeld, 1);
  EXPECT_TRUE(claw_.witness().touch);
}

// Any single witness against refuses the grasp; NaN and infinity are witnesses against.
TEST_F(Confirmation, RefusesWithOneAgainst) {
  for (const double jaw : {kClaw.closed_rad, kClaw.open_rad, kNan, kInfinity}) {
    show({true, jaw, -3.2}, 5);
    EXPECT_FALSE(claw_.conclude(kFirm).all());
  }
  for (const double torque : {0.0, 0.49, -0.49, kNan}) {
    show({true, kClaw.on_rung_rad, torque}, 5);
    EXPECT_FALSE(claw_.conclude(kFirm).all());
  }
  show({false, kClaw.on_rung_rad, -3.2}, 5);
  EXPECT_FALSE(claw_.conclude(kFirm).all());
  show(kHeld, 5);
  for (const PullResult pull :
       {PullResult{0.005, 65.0}, PullResult{0.0, 39.9}, PullResult{kNan, 65.0},
        PullResult{0.0, kNan}, PullResult{0.0, kInfinity}, PullResult{-0.006, 65.0}}) {
    EXPECT_FALSE(claw_.conclude(pull).all());
  }
}

// A plain miss is no contradiction; touch without a rung in the jaw is, three times in a row.
TEST_F(Confirmation, CountsContradictions) {
  show(kEmpty, 50);
  for (int i = 0; i < 5; ++i) claw_.conclude_missed();
  EXPECT_EQ(claw_.num_disagreements(), 0);
  for (int i = 0; i < 3; ++i) {
    EXPECT_FALSE(claw_.disagrees());
    show({true, kClaw.closed_rad, -6.0}, 5);
    claw_.conclude_missed();
  }
  EXPECT_TRUE(claw_.disagrees());
  show(kHeld, 5);
  EXPECT_TRUE(claw_.conclude(kFirm).all());
  EXPECT_FALSE(claw_.disagrees());
}

// Closed by all other witnesses, and three times in a row the pull test says no.
TEST_F(Confirmation, CountsFailedPullTests) {
  show(kHeld, 5);
  for (int i = 0; i < 3; ++i) {
    EXPECT_FALSE(claw_.disagrees());
    EXPECT_FALSE(claw_.conclude({0.02, 65.0}).all());
  }
  EXPECT_TRUE(claw_.disagrees());
}

// A switch that is closed while the claw stands open is stuck after 100 ms, not before.
TEST_F(Confirmation, FindsAStuckSwitch) {
  show({true, kClaw.open_rad, 0.0}, 9);
  EXPECT_FALSE(claw_.is_touch_stuck());
  show({true, kClaw.open_rad, 0.0}, 1);
  EXPECT_TRUE(claw_.is_touch_stuck());
  show(kOpen, 1);
  EXPECT_FALSE(claw_.is_touch_stuck());
}

// A held rung is lost after 20 ms without touch or with the jaw fallen through; one cycle is a
// bounce.
TEST_F(Confirmation, NoticesALoss) {
  show(kHeld, 10);
  EXPECT_FALSE(claw_.is_lost());
  show({false, kClaw.on_rung_rad, -3.2}, 1);
  EXPECT_FALSE(claw_.is_lost());
  show({false, kClaw.on_rung_rad, -3.2}, 1);
  EXPECT_TRUE(claw_.is_lost());
  show(kHeld, 1);
  EXPECT_FALSE(claw_.is_lost());
  show({true, kClaw.closed_rad, -6.0}, 2);
  EXPECT_TRUE(claw_.is_lost());
}

// A claw that begins to press anew is given time for its switch, none for a jaw that closes past
// where its rung was.
TEST_F(Confirmation, WaitsForTheSwitchAndNotForTheJaw) {
  const ClawReading slack{false, kClaw.on_rung_rad, -0.1};
  show(kHeld, 10);
  claw_.press_again(0.3);
  show(slack, 20);
  EXPECT_FALSE(claw_.is_lost());
  show({false, kClaw.closed_rad, -0.1}, 2);
  EXPECT_TRUE(claw_.is_lost());
  claw_.press_again(0.3);
  show(slack, 31);
  EXPECT_FALSE(claw_.is_lost());
  show(slack, 1);
  EXPECT_TRUE(claw_.is_lost());
}

// Time that is none does not count; parameters are checked.
TEST_F(Confirmation, IgnoresBadTime) {
  for (const double dt : {0.0, -1.0, kNan, kInfinity}) claw_.update(kHeld, dt);
  EXPECT_FALSE(claw_.witness().touch);
  EXPECT_EQ(check(ConfirmationParams()), "");
  ConfirmationParams bad;
  bad.touch_s = kNan;
  EXPECT_NE(check(bad), "");
}

}  // namespace
}  // namespace climb
