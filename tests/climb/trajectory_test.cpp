// SPDX-License-Identifier: BSD-3-Clause
// Joint segments, lines and the last cut: odd inputs, limits, continuity.
#include <gtest/gtest.h>

#include "climb/leg_trajectory.h"
#include "tests/climb/robot_poses.h"

namespace climb {
namespace {

using climb_tests::kInfinity;
using climb_tests::kNan;

const LegKinematics kKinematics{RobotParams()};
const LegLimits kLimits = leg_limits(kKinematics, kFrontLeft);
const LegAngles kSomewhere(0.1, -0.6, 1.2);

bool all_finite(const JointSample& s) {
  return s.angles_rad.allFinite() && s.velocity_rad_s.allFinite() &&
         s.acceleration_rad_s2.allFinite();
}

// A way of no length takes no time and stands there, at every time that can be asked.
TEST(JointSegment, OfNoLengthStands) {
  const JointSegment segment(kSomewhere, kSomewhere, kLimits);
  EXPECT_TRUE(segment.valid());
  EXPECT_EQ(segment.duration_s(), 0.0);
  for (const double t : {-1.0, 0.0, 1.0, kNan, kInfinity, -kInfinity}) {
    EXPECT_EQ(segment.at(t).angles_rad, kSomewhere);
    EXPECT_EQ(segment.at(t).velocity_rad_s, LegAngles::Zero());
  }
}

// Ends that are not finite make no motion and no NaN.
TEST(JointSegment, NeverGivesNan) {
  base::Rng rng(20);
  const double odd[] = {kNan, kInfinity, -kInfinity, 1e308, -1e308, 0.0, 1e-320};
  for (int i = 0; i < 2000; ++i) {
    LegAngles from = kSomewhere;
    LegAngles to = kSomewhere;
    from[rng.below(3)] = odd[rng.below(7)];
    to[rng.below(3)] = odd[rng.below(7)];
    const JointSegment segment(from, to, kLimits, i % 5 == 0 ? kNan : 0.0);
    for (const double t : {-1.0, 0.0, 0.3, 1e9, kNan, kInfinity}) {
      ASSERT_TRUE(all_finite(segment.at(t))) << from.transpose() << " -> " << to.transpose();
    }
    ASSERT_TRUE(segment.valid() || i % 5 == 0 || !from.allFinite() || !to.allFinite());
    ASSERT_TRUE(!segment.valid() || (from.allFinite() && to.allFinite()));
  }
}

// 1e5 random segments: ends met, never outside the box of its ends, speed and acceleration within
// the limits wherever sampled, and the fastest joint uses one limit up.
TEST(JointSegment, KeepsTheLimits) {
  base::Rng rng(21);
  double most_speed = 0.0;
  double most_acceleration = 0.0;
  for (int i = 0; i < 100000; ++i) {
    LegLimits limits = kLimits;
    for (JointLimits& limit : limits) {
      limit.max_velocity_rad_s = climb_tests::between(rng, 0.1, 5.0);
      limit.max_acceleration_rad_s2 = climb_tests::between(rng, 1.0, 50.0);
    }
    const LegAngles from = climb_tests::random_angles(rng, kKinematics, kFrontLeft);
    const double reach = i % 3 == 0 ? 0.01 : 1.0;
    const LegAngles to =
        from + reach * (climb_tests::random_angles(rng, kKinematics, kFrontLeft) - from);
    const JointSegment segment(from, to, limits);
    ASSERT_EQ(segment.at(0.0).angles_rad, from);
    ASSERT_EQ(segment.at(segment.duration_s()).angles_rad, to);
    double used = 0.0;
    for (int k = 0; k <= 40; ++k) {
      const JointSample here = segment.at(segment.duration_s() * k / 40.0);
      for (int joint = 0; joint < kNumLegJoints; ++joint) {
        const auto [low, high] = std::minmax(from[joint], to[joint]);
        ASSERT_GE(here.angles_rad[joint], low - 1e-12);
        ASSERT_LE(here.angles_rad[joint], high + 1e-12);
        const double speed =
            std::abs(here.velocity_rad_s[joint]) / limits[joint].max_velocity_rad_s;
        const double acceleration =
            std::abs(here.acceleration_rad_s2[joint]) / limits[joint].max_acceleration_rad_s2;
        most_speed = std::max(most_speed, speed);
        most_acceleration = std::max(most_acceleration, acceleration);
        used = std::max({used, speed, acceleration});
      }
    }
    ASSERT_GE(used, 0.98);
  }
  EXPECT_LE(most_speed, 1.0 + 1e-9);
  EXPECT_LE(most_acceleration, 1.0 + 1e-6);
}

// Velocity and acceleration are the derivatives of the angles, and vanish at both ends.
TEST(JointSegment, IsSmooth) {
  const LegAngles to(-0.3, 0.9, 2.0);
  const JointSegment segment(kSomewhere, to, kLimits);
  const double h = 1e-5;
  for (int k = 1; k < 100; ++k) {
    const double t = segment.duration_s() * k / 100.0;
    const JointSample here = segment.at(t);
    const LegAngles slope = (segment.at(t + h).angles_rad - segment.at(t - h).angles_rad) / (2 * h);
    const LegAngles bend =
        (segment.at(t + h).velocity_rad_s - segment.at(t - h).velocity_rad_s) / (2 * h);
    EXPECT_LE((here.velocity_rad_s - slope).norm(), 1e-7);
    EXPECT_LE((here.acceleration_rad_s2 - bend).norm(), 1e-6);
  }
  for (const double end : {0.0, segment.duration_s()}) {
    EXPECT_EQ(segment.at(end).velocity_rad_s, LegAngles::Zero());
    EXPECT_EQ(segment.at(end).acceleration_rad_s2, LegAngles::Zero());
  }
}

// A wished duration lengthens a segment and never shortens it.
TEST(JointSegment, TakesAtLeastTheWishedTime) {
  const JointSegment quick(kSomewhere, LegAngles(0.3, -0.6, 1.2), kLimits);
  EXPECT_EQ(JointSegment(kSomewhere, LegAngles(0.3, -0.6, 1.2), kLimits, 9.0).duration_s(), 9.0);
  EXPECT_EQ(JointSegment(kSomewhere, LegAngles(0.3, -0.6, 1.2), kLimits, 1e-9).duration_s(),
            quick.duration_s());
}

// A line is straight, meets its ends, and keeps its peak speed.
TEST(Line, IsStraightAndKeepsItsSpeed) {
  const Eigen::Vector3d from(0.3, 0.15, -0.23);
  const Eigen::Vector3d to(0.31, 0.14, -0.28);
  const Line line(from, to, 0.05, 1.0);
  double peak = 0.0;
  for (int k = 0; k <= 1000; ++k) {
    const LineSample here = line.at(line.duration_s() * k / 1000.0);
    peak = std::max(peak, here.velocity_m_s.norm());
    ASSERT_LE((here.point_m - from).cross(to - from).norm(), 1e-15);
  }
  EXPECT_NEAR(peak, 0.05, 1e-9);
  EXPECT_EQ(line.at(line.duration_s()).point_m, to);
  EXPECT_EQ(Line(from, from, 0.05, 1.0).duration_s(), 0.0);
}

// Odd ends and speeds make an invalid line that stands at a finite point.
TEST(Line, NeverGivesNan) {
  const Eigen::Vector3d here(0.3, 0.15, -0.23);
  const Eigen::Vector3d nowhere(kNan, 0.0, 0.0);
  for (const Line& line : {Line(here, nowhere, 0.05, 1.0), Line(nowhere, here, 0.05, 1.0),
                           Line(here, -here, 0.0, 1.0), Line(here, -here, 0.05, kNan)}) {
    EXPECT_FALSE(line.valid());
    EXPECT_EQ(line.duration_s(), 0.0);
    EXPECT_TRUE(line.at(0.5).point_m.allFinite());
  }
}

// However wild the wish, one step is bounded by speed and limits; no number = no motion.
TEST(ClampStep, BoundsAnyWish) {
  base::Rng rng(22);
  const double odd[] = {kNan, kInfinity, -kInfinity, 1e308, 0.0, 0.5};
  for (int i = 0; i < 20000; ++i) {
    const LegAngles last = climb_tests::random_angles(rng, kKinematics, kFrontLeft);
    LegAngles wish = last + climb_tests::in_box(rng, 3.0);
    if (i % 4 == 0) wish[rng.below(3)] = odd[rng.below(6)];
    const LegAngles next = clamp_step(last, wish, kLimits, 0.01);
    for (int joint = 0; joint < kNumLegJoints; ++joint) {
      ASSERT_LE(std::abs(next[joint] - last[joint]), 2.5 * 0.01 + 1e-12);
      ASSERT_GE(next[joint], kLimits[joint].min_rad);
      ASSERT_LE(next[joint], kLimits[joint].max_rad);
    }
  }
  EXPECT_EQ(clamp_step(kSomewhere, LegAngles(kNan, kNan, kNan), kLimits, 0.01), kSomewhere);
  EXPECT_EQ(clamp_step(kSomewhere, LegAngles::Zero(), kLimits, kNan), kSomewhere);
  EXPECT_EQ(clamp_step(kSomewhere, LegAngles::Zero(), kLimits, -1.0), kSomewhere);
}

}  // namespace
}  // namespace climb
