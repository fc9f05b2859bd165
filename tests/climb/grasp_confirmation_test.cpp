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
       {PullResult{0.0075, 65.0}, PullResult{0.0, 39.9}, PullResult{kNan, 65.0},
        PullResult{0.0, kNan}, PullResult{0.0, kInfinity}, PullResult{-0.008, 65.0}}) {
    EXPECT_FALSE(claw_.conclude(pull).all());
  }
}

// Each rung that the claw can hold asks for its own jaw angle: told its radius, within 1.5 mm, a
// jaw that stands there is on it, also pulled at (the numbers of the simulated claw); one that
// stands as on a rung 10 mm thicker is not.
TEST_F(Confirmation, ExpectsTheRungsThickness) {
  struct Measured {
    double diameter_m;
    double at_rest_rad;
    double pulled_rad;
  };
  constexpr Measured kMeasured[] = {{0.024, -0.544, -0.445},
                                    {0.027, -0.450, -0.437},
                                    {0.030, -0.361, -0.343},
                                    {0.034, -0.238, -0.208},
                                    {0.040, -0.037, -0.009}};
  for (const Measured& m : kMeasured) {
    for (const double error_m : {-0.0015, 0.0, 0.0015}) {
      claw_.expect({0.5 * m.diameter_m + error_m, 0.0});
      for (const double jaw_rad : {m.at_rest_rad, m.pulled_rad}) {
        show({true, jaw_rad, -3.2}, 5);
        EXPECT_TRUE(claw_.conclude(kFirm).all()) << m.diameter_m << ' ' << error_m;
      }
    }
    claw_.expect({0.5 * m.diameter_m, 0.0});
    show({true, m.at_rest_rad + 0.3, -3.2}, 5);
    EXPECT_FALSE(claw_.conclude(kFirm).all()) << m.diameter_m;
  }
}

// A rung that lies aslant in the claw opens it wider (as measured), whichever way it leans.
TEST_F(Confirmation, ExpectsARungAslant) {
  for (const double skew : {-0.12, 0.12}) {
    const JawWindow straight = jaw_window(kClaw, {0.014, 0.0});
    const JawWindow aslant = jaw_window(kClaw, {0.014, skew});
    EXPECT_NEAR(aslant.high_rad - straight.high_rad, 0.078, 0.015);
    EXPECT_EQ(aslant.low_rad, straight.low_rad);
  }
}

// An empty claw, whose jaw stands at its stop or a little before it, is full on no rung, whatever
// was told of it; nor is an open one.
TEST_F(Confirmation, AnEmptyClawIsNeverFull) {
  for (const double radius_m : {0.0, 0.001, 0.0115, 0.014, 0.021, 0.05, -1.0, kNan, kInfinity}) {
    for (const double skew : {0.0, 0.3, -5.0, kNan, kInfinity}) {
      claw_.expect({radius_m, skew});
      for (const double jaw_rad : {-0.65, kClaw.closed_rad, kClaw.empty_rad - 0.001, 1.1, 1.2}) {
        show({true, jaw_rad, -6.0}, 5);
        EXPECT_FALSE(claw_.witness().jaw) << radius_m << ' ' << skew << ' ' << jaw_rad;
        EXPECT_FALSE(claw_.conclude(kFirm).all());
      }
    }
  }
}

// Of a rung that nobody has seen every thickness will do that the claw can hold.
TEST_F(Confirmation, HoldsAnyRungThatNobodySaw) {
  for (const double jaw_rad : {-0.56, -0.45, -0.2, -0.03}) {
    show({true, jaw_rad, -3.2}, 5);
    EXPECT_TRUE(claw_.conclude(kFirm).all()) << jaw_rad;
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
