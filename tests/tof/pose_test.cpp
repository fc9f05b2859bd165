// SPDX-License-Identifier: BSD-3-Clause
// Poses, their interpolation, and the buffer that answers for a time.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/rng.h"
#include "tests/tof/frame_builder.h"
#include "tof/pose_buffer.h"

namespace {

using tof_test::turn;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();

tof::Pose at_x(double x_m, double yaw_rad = 0.0) {
  return {Eigen::Vector3d(x_m, 0.0, 0.0), turn(yaw_rad, kUp)};
}

tof::PoseBuffer buffer(int capacity = 8) {
  tof::PoseParams params;
  params.capacity = capacity;
  params.max_gap_s = 0.2;
  params.max_extrapolation_s = 0.05;
  return tof::PoseBuffer(params);
}

// An empty buffer says so, at any time.
TEST(PoseBuffer, EmptyHasNoPose) {
  EXPECT_FALSE(buffer().at(0).has_value());
  EXPECT_FALSE(buffer().newest().has_value());
}

// What is not a pose, or not newer, changes nothing.
TEST(PoseBuffer, RejectsUnsoundAndOld) {
  tof::PoseBuffer poses = buffer();
  EXPECT_FALSE(poses.push(100, at_x(kNaN)));
  tof::Pose no_rotation;
  no_rotation.q = Eigen::Quaterniond(0.0, 0.0, 0.0, 0.0);
  EXPECT_FALSE(poses.push(100, no_rotation));
  EXPECT_TRUE(poses.push(100, at_x(1.0)));
  EXPECT_FALSE(poses.push(100, at_x(2.0)));
  EXPECT_FALSE(poses.push(99, at_x(2.0)));
  EXPECT_EQ(poses.newest()->p_m.x(), 1.0);
}

// One pose holds for the extrapolation time on both sides, and no longer.
TEST(PoseBuffer, OnePoseHoldsBriefly) {
  tof::PoseBuffer poses = buffer();
  poses.push(1'000'000, at_x(3.0));
  for (const std::int64_t offset_us : {-50'000, 0, 50'000}) {
    ASSERT_TRUE(poses.at(1'000'000 + offset_us).has_value()) << offset_us;
    EXPECT_EQ(poses.at(1'000'000 + offset_us)->p_m.x(), 3.0);
  }
  EXPECT_FALSE(poses.at(1'050'001).has_value());
  EXPECT_FALSE(poses.at(949'999).has_value());
}

// Between two poses it is linear; through a longer gap there is none.
TEST(PoseBuffer, InterpolatesButNotThroughGaps) {
  tof::PoseBuffer poses = buffer();
  poses.push(0 + 1'000'000, at_x(0.0, 0.0));
  poses.push(100'000 + 1'000'000, at_x(1.0, 0.2));
  poses.push(400'000 + 1'000'000, at_x(2.0, 0.2));
  const auto pose = poses.at(1'025'000);
  ASSERT_TRUE(pose.has_value());
  EXPECT_NEAR(pose->p_m.x(), 0.25, 1e-12);
  EXPECT_NEAR(pose->q.angularDistance(turn(0.05, kUp)), 0.0, 1e-4);
  EXPECT_FALSE(poses.at(1'200'000).has_value());
  EXPECT_EQ(poses.at(1'400'000)->p_m.x(), 2.0);
}

// Beyond the newest pose the motion goes on along a baseline that does not amplify noise.
TEST(PoseBuffer, ExtrapolatesOverAWideBaseline) {
  tof::PoseBuffer poses = buffer(64);
  for (int i = 0; i <= 20; ++i) {
    const double noise_m = i == 20 ? 0.001 : 0.0;
    poses.push(1'000'000 + 10'000 * i, at_x(0.1 * 0.01 * i + noise_m));
  }
  const auto pose = poses.at(1'250'000);
  ASSERT_TRUE(pose.has_value());
  EXPECT_NEAR(pose->p_m.x(), 0.025 + 2 * 0.001, 1e-9);
  EXPECT_FALSE(poses.at(1'250'001).has_value());
}

// A full buffer forgets the oldest and still finds every pose it keeps.
TEST(PoseBuffer, IsBounded) {
  tof::PoseBuffer poses = buffer(4);
  for (int i = 1; i <= 10; ++i) poses.push(100'000 * i, at_x(i));
  for (int i = 7; i <= 10; ++i) EXPECT_EQ(poses.at(100'000 * i)->p_m.x(), i);
  EXPECT_FALSE(poses.at(600'000).has_value());
  poses.clear();
  EXPECT_FALSE(poses.at(1'000'000).has_value());
}

// q and -q are one rotation: the way between neighbours never goes round the far side.
TEST(Pose, InterpolationTakesTheShortWay) {
  tof::Pose a = at_x(0.0, 0.1);
  tof::Pose b = at_x(0.0, 0.3);
  b.q.coeffs() *= -1.0;
  EXPECT_NEAR(tof::interpolate(a, b, 0.5).q.angularDistance(turn(0.2, kUp)), 0.0, 1e-6);
  EXPECT_TRUE(tof::is_sound(tof::interpolate(at_x(0.0, 0.0), at_x(0.0, M_PI), 0.5)));
}

// It takes one vector to the other, about the axis across both, also for opposite ones.
TEST(Pose, SmallestRotation) {
  base::Rng rng(5);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d a =
        Eigen::Vector3d(rng.gaussian(), rng.gaussian(), rng.gaussian()).normalized();
    Eigen::Vector3d b =
        Eigen::Vector3d(rng.gaussian(), rng.gaussian(), rng.gaussian()).normalized();
    if (i % 10 == 0) b = -a;
    if (i % 10 == 1) b = a;
    if (i % 10 == 2) b = (-a + 1e-6 * b).normalized();
    const Eigen::Quaterniond q = tof::smallest_rotation(a, b);
    EXPECT_NEAR(q.norm(), 1.0, 1e-12);
    EXPECT_LT((q * a - b).norm(), 1e-4);
    EXPECT_NEAR(2.0 * std::atan2(q.vec().norm(), q.w()), std::acos(std::clamp(a.dot(b), -1., 1.)),
                1e-4);
  }
}

}  // namespace
