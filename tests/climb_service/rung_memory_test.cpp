// SPDX-License-Identifier: BSD-3-Clause
// Sound rungs are remembered below the head of the robot, and only there; damage everywhere.
#include "climb_controller/rung_memory.h"

#include <gtest/gtest.h>

namespace climb_controller {
namespace {

constexpr std::int64_t kSecond_us = 1'000'000;

class RungMemoryTest : public ::testing::Test {
 protected:
  RungMemoryTest() {
    snapshot_.reserve();
    // The body's x points up.
    T_odom_body_.linear() << 0, 0, -1, 0, 1, 0, 1, 0, 0;
  }
  void see(double height_m, bool trusted = true, bool damaged = false) {
    climb::RungView rung;
    rung.id = 5;
    rung.trusted = trusted;
    rung.damaged = damaged;
    rung.confidence = 1.0;
    rung.end0_m = {0.28, 0.2, height_m};
    rung.end1_m = {0.28, -0.2, height_m};
    rung.radius_m = 0.014;
    snapshot_.rungs.assign(1, rung);
    snapshot_.stretches.clear();
    if (trusted && !damaged) snapshot_.stretches.push_back({0, 0.05, 0.35});
    snapshot_.confirmed = trusted;
  }
  void see_nothing() {
    snapshot_.rungs.clear();
    snapshot_.stretches.clear();
    snapshot_.confirmed = false;
  }
  void complete(double at_s, double body_height_m) {
    T_odom_body_.translation().z() = body_height_m;
    memory_.complete(static_cast<std::int64_t>(at_s * 1e6) + kSecond_us, T_odom_body_, snapshot_);
  }
  RungMemory memory_{RungMemoryParams{}};
  RungsSnapshot snapshot_;
  Eigen::Isometry3d T_odom_body_ = Eigen::Isometry3d::Identity();
};

/// A sound rung that is no longer seen is offered once it lies under the belly, at its place.
TEST_F(RungMemoryTest, KeepsWhatTheBellyHides) {
  see(0.6);
  complete(0.0, 0.0);
  see_nothing();
  complete(10.0, 0.5);
  ASSERT_EQ(snapshot_.rungs.size(), 1U);
  EXPECT_TRUE(snapshot_.rungs[0].trusted);
  EXPECT_DOUBLE_EQ(snapshot_.rungs[0].end0_m.z(), 0.6);
  ASSERT_EQ(snapshot_.stretches.size(), 1U);
  EXPECT_EQ(snapshot_.stretches[0].rung_index, 0);
  EXPECT_TRUE(snapshot_.confirmed);
}

/// Far ahead of the robot nothing is remembered.
TEST_F(RungMemoryTest, ForgetsFarAhead) {
  see(0.9);
  complete(0.0, 0.0);
  see_nothing();
  complete(0.1, 0.1);
  EXPECT_TRUE(snapshot_.rungs.empty());
  EXPECT_FALSE(snapshot_.confirmed);
}

/// After memory_s it is gone; a clock that stands adds nothing twice.
TEST_F(RungMemoryTest, ForgetsInTime) {
  see(0.6);
  complete(0.0, 0.5);
  complete(0.0, 0.5);
  EXPECT_EQ(snapshot_.rungs.size(), 1U);
  see_nothing();
  complete(91.0, 0.5);
  EXPECT_TRUE(snapshot_.rungs.empty());
}

/// What was never trusted is not remembered, and a damaged rung only as such.
TEST_F(RungMemoryTest, LearnsSoundRungsOnly) {
  see(0.6, true, true);
  complete(0.0, 0.0);
  see(0.6, false);
  complete(0.1, 0.0);
  see_nothing();
  complete(1.0, 0.5);
  ASSERT_EQ(snapshot_.rungs.size(), 1U);
  EXPECT_TRUE(snapshot_.rungs[0].damaged);
  EXPECT_TRUE(snapshot_.stretches.empty());
  memory_ = RungMemory(RungMemoryParams{});
  see(0.6, false);
  complete(2.0, 0.0);
  see_nothing();
  complete(3.0, 0.5);
  EXPECT_TRUE(snapshot_.rungs.empty());
}

/// What is remembered was trusted at least as well once as when it was last seen.
TEST_F(RungMemoryTest, KeepsTheBestConfidence) {
  see(0.6);
  complete(0.0, 0.0);
  see(0.6);
  snapshot_.rungs[0].confidence = 0.1;
  complete(1.0, 0.0);
  see_nothing();
  complete(2.0, 0.0);
  ASSERT_EQ(snapshot_.rungs.size(), 1U);
  EXPECT_DOUBLE_EQ(snapshot_.rungs[0].confidence, 1.0);
}

/// Damage that is seen counts, and goes on counting when the rung is hidden or looks sound once.
TEST_F(RungMemoryTest, DamageSeenCounts) {
  for (const double body_m : {-0.3, 0.0, 0.15}) {
    see(0.6);
    complete(0.0, 0.0);
    see(0.6, true, true);
    complete(1.0, body_m);
    ASSERT_EQ(snapshot_.rungs.size(), 1U);
    EXPECT_TRUE(snapshot_.rungs[0].damaged);
    EXPECT_TRUE(snapshot_.stretches.empty());
    see(0.6);
    complete(1.1, body_m);
    EXPECT_TRUE(snapshot_.rungs[0].damaged);
    see_nothing();
    complete(2.0, 0.5);
    ASSERT_EQ(snapshot_.rungs.size(), 1U);
    EXPECT_TRUE(snapshot_.rungs[0].damaged);
    memory_ = RungMemory(RungMemoryParams{});
  }
}

/// Between the own legs damage counts as long as it is seen, and a sound rung is sound again then.
TEST_F(RungMemoryTest, DamageBetweenTheLegsIsNotRemembered) {
  see(0.6);
  complete(0.0, 0.0);
  see(0.6, true, true);
  complete(1.0, 0.3);
  ASSERT_EQ(snapshot_.rungs.size(), 1U);
  EXPECT_TRUE(snapshot_.rungs[0].damaged);
  EXPECT_TRUE(snapshot_.stretches.empty());
  see_nothing();
  complete(1.1, 0.3);
  ASSERT_EQ(snapshot_.rungs.size(), 1U);
  EXPECT_FALSE(snapshot_.rungs[0].damaged);
  EXPECT_EQ(snapshot_.stretches.size(), 1U);
}

/// A rung that looked sound long enough where no own leg is before it stays sound between the legs,
/// at its place; one that did not, or that was seen damaged since, does not.
TEST_F(RungMemoryTest, LongSeenSoundStaysSoundBetweenTheLegs) {
  const int enough = RungMemoryParams{}.sound_frames;
  for (const int looks : {enough, enough - 1}) {
    memory_ = RungMemory(RungMemoryParams{});
    for (int i = 0; i < looks; ++i) {
      see(0.6);
      complete(0.1 * i, 0.0);
    }
    see(0.61, true, true);
    complete(2.0, 0.3);
    ASSERT_EQ(snapshot_.rungs.size(), 1U);
    EXPECT_EQ(snapshot_.rungs[0].damaged, looks < enough);
    EXPECT_EQ(snapshot_.stretches.empty(), looks < enough);
    const double height_m = looks < enough ? 0.61 : 0.6;
    EXPECT_NEAR(snapshot_.rungs[0].end0_m.z(), height_m, 1e-9);
  }
  for (int i = 0; i < enough; ++i) {
    see(0.6, i != 3, i == 3);
    complete(3.0 + 0.1 * i, 0.0);
  }
  see(0.6, true, true);
  complete(5.0, 0.3);
  EXPECT_TRUE(snapshot_.rungs[0].damaged);
}

/// Of a rung that is not trusted one damaged look proves nothing, three within a second do.
TEST_F(RungMemoryTest, DamageOfAnUntrustedRungCountsWhenItLasts) {
  see(0.6);
  complete(0.0, 0.0);
  for (const double at_s : {1.0, 3.0, 5.0, 5.1}) {
    see(0.6, false, true);
    complete(at_s, 0.1);
    see_nothing();
    complete(at_s + 0.01, 0.5);
    ASSERT_EQ(snapshot_.rungs.size(), 1U) << at_s;
    EXPECT_FALSE(snapshot_.rungs[0].damaged) << at_s;
  }
  see(0.6, false, true);
  complete(5.2, 0.1);
  see_nothing();
  complete(5.3, 0.5);
  ASSERT_EQ(snapshot_.rungs.size(), 1U);
  EXPECT_TRUE(snapshot_.rungs[0].damaged);
}

/// What looked damaged is sound again once it was seen so, and trusted, for long enough.
TEST_F(RungMemoryTest, SoundLooksClearDamage) {
  see(0.6, true, true);
  complete(0.0, 0.0);
  for (int i = 1; i < 12; ++i) {
    see(0.6);
    complete(0.1 * i, 0.0);
    ASSERT_TRUE(snapshot_.rungs[0].damaged) << i;
    see(0.6, false);
    complete(0.1 * i + 0.05, 0.0);
    ASSERT_TRUE(snapshot_.rungs[0].damaged) << i;
  }
  see(0.6);
  complete(2.0, 0.0);
  EXPECT_FALSE(snapshot_.rungs[0].damaged);
  see_nothing();
  complete(3.0, 0.5);
  ASSERT_EQ(snapshot_.rungs.size(), 1U);
  EXPECT_FALSE(snapshot_.rungs[0].damaged);
  ASSERT_EQ(snapshot_.stretches.size(), 1U);
}

/// A rung that is seen but not trusted any more takes its trust from memory and its place from
/// what is seen.
TEST_F(RungMemoryTest, PlaceIsNews) {
  see(0.60);
  complete(0.0, 0.0);
  see(0.61, false);
  complete(1.0, 0.5);
  ASSERT_EQ(snapshot_.rungs.size(), 1U);
  EXPECT_TRUE(snapshot_.rungs[0].trusted);
  EXPECT_NEAR(snapshot_.rungs[0].end0_m.z(), 0.61, 1e-9);
}

/// The first look at a rung is no better than others: while nothing hides it, its thickness is what
/// was seen last, and so is how well its place is known.
TEST_F(RungMemoryTest, ThicknessAndCertaintyAreNews) {
  see(0.6);
  snapshot_.rungs[0].radius_m = 0.022;
  snapshot_.rungs[0].covariance_m2 = Eigen::Matrix3d::Identity() * 1e-4;
  complete(0.0, 0.0);
  see(0.6);
  snapshot_.rungs[0].radius_m = 0.014;
  snapshot_.rungs[0].covariance_m2 = Eigen::Matrix3d::Identity() * 9e-6;
  complete(1.0, 0.0);
  see_nothing();
  complete(2.0, 0.0);
  ASSERT_EQ(snapshot_.rungs.size(), 1U);
  EXPECT_DOUBLE_EQ(snapshot_.rungs[0].radius_m, 0.014);
  EXPECT_DOUBLE_EQ(snapshot_.rungs[0].covariance_m2(2, 2), 9e-6);
}

/// A leg before a rung spoils its thickness, not that which is remembered.
TEST_F(RungMemoryTest, ThicknessOfAHiddenRungIsNoNews) {
  see(0.6);
  snapshot_.rungs[0].radius_m = 0.014;
  complete(0.0, 0.0);
  see(0.6);
  snapshot_.rungs[0].radius_m = 0.009;
  snapshot_.stretches[0].to_m = snapshot_.stretches[0].from_m + 0.1;
  complete(1.0, 0.0);
  ASSERT_EQ(snapshot_.rungs.size(), 1U);
  EXPECT_DOUBLE_EQ(snapshot_.rungs[0].radius_m, 0.014);
}

}  // namespace
}  // namespace climb_controller
