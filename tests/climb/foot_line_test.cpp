// SPDX-License-Identifier: BSD-3-Clause
// Straight lines of a foot through the inverse kinematics.
#include "climb/foot_line.h"

#include <gtest/gtest.h>

#include "tests/climb/robot_poses.h"

namespace climb {
namespace {

using climb_tests::kNan;

const LegKinematics kKinematics{RobotParams()};

// A line with an end that is unreachable, or not finite, tells why and stands still.
TEST(FootLine, TellsWhyItCannotBeFollowed) {
  const Eigen::Vector3d here(0.3, 0.15, -0.28);
  const FootLine too_far(kKinematics, kFrontLeft, here, Eigen::Vector3d(1.0, 0.15, -0.28), {});
  EXPECT_EQ(too_far.reach(), Reach::kTooFar);
  EXPECT_EQ(too_far.duration_s(), 0.0);
  EXPECT_LE((kKinematics.foot_m(kFrontLeft, too_far.at(1.0).angles_rad) - here).norm(), 1e-12);
  const FootLine nowhere(kKinematics, kFrontLeft, here, Eigen::Vector3d(kNan, 0.0, 0.0), {});
  EXPECT_EQ(nowhere.reach(), Reach::kNotFinite);
  EXPECT_TRUE(nowhere.at(0.1).angles_rad.allFinite());
  const FootLine from_nowhere(kKinematics, kFrontLeft, Eigen::Vector3d(0, 0, kNan), here, {});
  EXPECT_NE(from_nowhere.reach(), Reach::kReachable);
  EXPECT_TRUE(from_nowhere.at(kNan).angles_rad.allFinite());
}

// A line of no length stands at its point.
TEST(FootLine, OfNoLengthStands) {
  const Eigen::Vector3d here(0.3, 0.15, -0.28);
  const FootLine line(kKinematics, kFrontLeft, here, here, {});
  EXPECT_EQ(line.reach(), Reach::kReachable);
  EXPECT_EQ(line.duration_s(), 0.0);
  EXPECT_LE((kKinematics.foot_m(kFrontLeft, line.at(5.0).angles_rad) - here).norm(), 1e-12);
}

// Random reachable lines at any asked speed: the foot stays on the line, the joints within their
// speed and acceleration, and the derivatives are those of the angles.
TEST(FootLine, IsStraightAndWithinTheJointLimits) {
  base::Rng rng(30);
  int num_followed = 0;
  for (int i = 0; i < 3000; ++i) {
    const Leg leg = kLegs[i % kNumLegs];
    const Eigen::Vector3d middle(lengthwise_sign(leg) * 0.25, lateral_sign(leg) * 0.15, -0.25);
    const Eigen::Vector3d from = middle + climb_tests::in_box(rng, 0.12);
    const Eigen::Vector3d to = middle + climb_tests::in_box(rng, 0.12);
    const LineSpeed speed{climb_tests::between(rng, 0.02, 2.0),
                          climb_tests::between(rng, 0.5, 20.0)};
    const FootLine line(kKinematics, leg, from, to, speed);
    if (line.reach() != Reach::kReachable) continue;
    ++num_followed;
    const LegLimits limits = leg_limits(kKinematics, leg);
    const double h = 1e-5;
    for (int k = 1; k < 97; ++k) {
      const double t = line.duration_s() * k / 97.0;
      const JointSample here = line.at(t);
      const Eigen::Vector3d foot = kKinematics.foot_m(leg, here.angles_rad);
      ASSERT_LE((foot - from).cross((to - from).normalized()).norm(), 1e-10);
      for (int joint = 0; joint < kNumLegJoints; ++joint) {
        ASSERT_LE(std::abs(here.velocity_rad_s[joint]), limits[joint].max_velocity_rad_s);
        ASSERT_LE(std::abs(here.acceleration_rad_s2[joint]), limits[joint].max_acceleration_rad_s2);
      }
      const LegAngles slope = (line.at(t + h).angles_rad - line.at(t - h).angles_rad) / (2 * h);
      const LegAngles bend =
          (line.at(t + h).velocity_rad_s - line.at(t - h).velocity_rad_s) / (2 * h);
      ASSERT_LE((here.velocity_rad_s - slope).norm(), 1e-5);
      ASSERT_LE((here.acceleration_rad_s2 - bend).norm(), 1e-3);
    }
  }
  EXPECT_GT(num_followed, 1500);
}

}  // namespace
}  // namespace climb
