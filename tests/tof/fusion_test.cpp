// SPDX-License-Identifier: BSD-3-Clause
// The whole library: frames, samples and poses in, clouds out.
#include "tof/fusion.h"

#include <cmath>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include "base/rng.h"
#include "tests/tof/frame_builder.h"

namespace {

using tof_test::FrameBuilder;
using tof_test::kPeriod_us;
using tof_test::kStart_us;
using tof_test::turn;

/// The first cloud waits for head 0 alone.
tof::TofParams one_head() {
  tof::TofParams params;
  params.heads.awaited_at_start = 1;
  return params;
}

const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();

void add_rest(tof::Fusion& fusion, std::int64_t utime_us, const Eigen::Vector3d& up_body = kUp) {
  fusion.add_imu({utime_us, 9.81 * up_body, Eigen::Vector3d::Zero()});
}

Eigen::Vector3d point(const tof::Cloud& cloud, std::size_t i) {
  return {cloud.x_m[i], cloud.y_m[i], cloud.z_m[i]};
}

// A frame that is not one is refused and counted, and the next good one is served.
TEST(Fusion, UnsoundFramesLeaveNoTrace) {
  tof::Fusion fusion{one_head()};
  FrameBuilder builder;
  auto bad = builder.view(0, kStart_us, 0);
  bad.intrinsics.fx_px = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(fusion.add_frame(bad).fault, tof::FrameFault::kIntrinsics);
  bad = builder.view(7, kStart_us + 1'000'000'000, 0);
  EXPECT_EQ(fusion.add_frame(bad).fault, tof::FrameFault::kHead);
  EXPECT_EQ(fusion.counters().frames_rejected, 2);
  const auto result = fusion.add_frame(builder.view(0, kStart_us, 0));
  ASSERT_EQ(result.clouds.size(), 1U);
  EXPECT_EQ(result.clouds[0].size(), 12U);
}

// A head that sees nothing still gives a cloud: empty, with its time and position.
TEST(Fusion, NothingSeenIsACloudWithoutPoints) {
  tof::Fusion fusion{one_head()};
  FrameBuilder builder(8, 8, 0);
  builder.frame.T_body_head.p_m = {0.3, 0.1, 0.2};
  add_rest(fusion, kStart_us);
  const auto result = fusion.add_frame(builder.view(0, kStart_us, 0));
  ASSERT_EQ(result.clouds.size(), 1U);
  const tof::Cloud& cloud = result.clouds[0];
  EXPECT_EQ(cloud.size(), 0U);
  EXPECT_EQ(cloud.head_utime_us[0], kStart_us);
  EXPECT_EQ(cloud.head_state[0], tof::HeadState::kLive);
  EXPECT_EQ(cloud.head_state[1], tof::HeadState::kUnknown);
  EXPECT_LT((cloud.head_position_m[0] - Eigen::Vector3f(0.3F, 0.1F, 0.2F)).norm(), 1e-6F);
  EXPECT_FLOAT_EQ(cloud.range_max_m, 4.0F);
  EXPECT_FLOAT_EQ(cloud.pixel_pitch_rad, 1.0F / 200.0F);
}

// Without inertial unit and odometry the points come in body axes, and the cloud says so.
TEST(Fusion, NeitherGravityNorOdometry) {
  tof::Fusion fusion{one_head()};
  FrameBuilder builder(3, 3, 1000);
  const auto result = fusion.add_frame(builder.view(0, kStart_us, 0));
  ASSERT_EQ(result.clouds.size(), 1U);
  EXPECT_EQ(result.clouds[0].pose_source, tof::PoseSource::kUnknown);
  EXPECT_LT((point(result.clouds[0], 4) - Eigen::Vector3d(1.0, 0.0, 0.0)).norm(), 1e-6);
}

// In any attitude, pitch 90 and upside-down included, the point ahead of head 0 lies on the plane
// y = 0 with x > 0, and its height is the true one.
TEST(Fusion, GravityLevelsAnyAttitude) {
  base::Rng rng(4);
  for (int trial = 0; trial < 100; ++trial) {
    Eigen::Quaterniond q_world_body =
        turn(6.0 * rng.uniform(), {rng.gaussian(), rng.gaussian(), rng.gaussian()});
    if (trial == 0) q_world_body = turn(-M_PI / 2, Eigen::Vector3d::UnitY());
    if (trial == 1) q_world_body = turn(M_PI, Eigen::Vector3d::UnitX());
    FrameBuilder builder(3, 3, 1000);
    builder.frame.T_body_head.q = turn(0.5, Eigen::Vector3d::UnitZ()) * tof_test::looking_ahead();
    tof::Fusion fusion{one_head()};
    add_rest(fusion, kStart_us, q_world_body.inverse() * kUp);
    const auto result = fusion.add_frame(builder.view(0, kStart_us, 0));
    ASSERT_EQ(result.clouds.size(), 1U);
    const tof::Cloud& cloud = result.clouds[0];
    EXPECT_EQ(cloud.pose_source, tof::PoseSource::kGravity);
    const Eigen::Vector3d seen = point(cloud, 4);
    const Eigen::Vector3d world =
        q_world_body * (builder.frame.T_body_head.q * Eigen::Vector3d(0.0, 0.0, 1.0));
    EXPECT_NEAR(seen.z(), world.z(), 1e-5) << trial;
    EXPECT_NEAR(seen.norm(), 1.0, 1e-5) << trial;
    if (std::abs(world.z()) > 0.99) continue;
    EXPECT_NEAR(seen.y(), 0.0, 1e-4) << trial;
    EXPECT_GT(seen.x(), 0.0) << trial;
  }
}

// Odometry wins over gravity, and each head is placed with the pose of its own time.
TEST(Fusion, EachHeadAtItsOwnTime) {
  tof::Fusion fusion{one_head()};
  FrameBuilder builder(3, 3, 1000);
  add_rest(fusion, kStart_us);
  fusion.add_frame(builder.view(0, kStart_us - kPeriod_us, 0));
  for (int i = -10; i <= 10; ++i) {  // 1 m/s along x
    tof::Pose pose;
    pose.p_m.x() = 0.01 * i;
    ASSERT_TRUE(fusion.add_pose(kStart_us + 10'000 * i, pose));
  }
  EXPECT_TRUE(fusion.add_frame(builder.view(1, kStart_us - 25'000, 0)).clouds.empty());
  const auto result = fusion.add_frame(builder.view(0, kStart_us, 1));
  ASSERT_EQ(result.clouds.size(), 1U);
  const tof::Cloud& cloud = result.clouds[0];
  EXPECT_EQ(cloud.pose_source, tof::PoseSource::kOdometry);
  EXPECT_EQ(cloud.utime_us, kStart_us);
  EXPECT_EQ(cloud.head_utime_us[1], kStart_us - 25'000);
  EXPECT_NEAR(cloud.head_position_m[0].x(), 0.0, 1e-6);
  EXPECT_NEAR(cloud.head_position_m[1].x(), -0.025, 1e-6);
  EXPECT_NEAR(cloud.T_odom_body.p_m.x(), 0.0, 1e-9);
  ASSERT_EQ(cloud.size(), 18U);
  EXPECT_NEAR(point(cloud, 4).x(), 1.0, 1e-6);
  EXPECT_NEAR(point(cloud, 13).x(), 0.975, 1e-6);
  EXPECT_EQ(cloud.head[0], 0);
  EXPECT_EQ(cloud.head[17], 1);
}

// Odometry that falls silent leaves the body where it was last seen; odom never jumps back to it.
TEST(Fusion, SilentOdometryHoldsTheLastPose) {
  tof::Fusion fusion{one_head()};
  FrameBuilder builder(3, 3, 1000);
  tof::Pose pose;
  pose.p_m = {5.0, 1.0, 2.0};
  fusion.add_pose(kStart_us, pose);
  add_rest(fusion, kStart_us + 1'000'000);
  const auto result = fusion.add_frame(builder.view(0, kStart_us + 1'000'000, 0));
  ASSERT_EQ(result.clouds.size(), 1U);
  EXPECT_EQ(result.clouds[0].pose_source, tof::PoseSource::kUnknown);
  EXPECT_NEAR(result.clouds[0].T_odom_body.p_m.x(), 5.0, 1e-12);
}

// A second frame may close one cloud and complete the next.
TEST(Fusion, TwoCloudsAtOnce) {
  tof::Fusion fusion{one_head()};
  FrameBuilder builder(3, 3, 1000);
  EXPECT_TRUE(fusion.add_frame(builder.view(2, kStart_us, 0)).clouds.empty());
  const auto result = fusion.add_frame(builder.view(2, kStart_us + kPeriod_us, 1));
  ASSERT_EQ(result.clouds.size(), 2U);
  EXPECT_EQ(result.clouds[0].utime_us, kStart_us);
  EXPECT_EQ(result.clouds[1].utime_us, kStart_us + kPeriod_us);
}

// utime of clouds only ever grows: a set with nothing newer is dropped and counted.
TEST(Fusion, CloudTimesAscend) {
  tof::Fusion fusion{one_head()};
  FrameBuilder builder(3, 3, 1000);
  fusion.add_frame(builder.view(0, kStart_us + 100'000, 0));
  fusion.add_frame(builder.view(1, kStart_us + 20'000, 0));
  const auto result = fusion.add_frame(builder.view(1, kStart_us + 87'000, 1));
  EXPECT_TRUE(result.clouds.empty());
  EXPECT_EQ(fusion.counters().clouds_suppressed, 1);
}

// Time that goes back is a new recording: it works like the first, heading included.
TEST(Fusion, TimeBackwardsIsANewRecording) {
  tof::Fusion fusion{one_head()};
  FrameBuilder ahead(3, 3, 1000);
  FrameBuilder aside(3, 3, 1000);
  aside.frame.T_body_head.q = turn(1.0, kUp) * tof_test::looking_ahead();
  add_rest(fusion, kStart_us + 60'000'000);
  fusion.add_frame(ahead.view(0, kStart_us + 60'000'000, 900));
  add_rest(fusion, kStart_us);
  const auto result = fusion.add_frame(aside.view(0, kStart_us, 0));
  EXPECT_EQ(fusion.counters().recordings, 1);
  ASSERT_EQ(result.clouds.size(), 1U);
  EXPECT_EQ(result.clouds[0].utime_us, kStart_us);
  EXPECT_NEAR(point(result.clouds[0], 4).y(), 0.0, 1e-5);
  EXPECT_EQ(fusion.head_counters(0).accepted, 2);
}

// So is time that jumps ahead; a head that was dead for long while others lived is not.
TEST(Fusion, TimeAheadIsANewRecordingUnlessOthersKeptGoing) {
  tof::Fusion fusion{one_head()};
  FrameBuilder builder(3, 3, 1000);
  fusion.add_frame(builder.view(0, kStart_us, 0));
  for (int second = 0; second < 30; ++second) add_rest(fusion, kStart_us + 1'000'000 * second);
  fusion.add_frame(builder.view(0, kStart_us + 30'000'000, 450));
  EXPECT_EQ(fusion.counters().recordings, 0);
  fusion.add_frame(builder.view(0, kStart_us + 90'000'000, 451));
  EXPECT_EQ(fusion.counters().recordings, 1);
}

// One stamp of nonsense costs two resets and nothing more.
TEST(Fusion, OneCorruptStamp) {
  tof::Fusion fusion{one_head()};
  FrameBuilder builder(3, 3, 1000);
  fusion.add_frame(builder.view(0, kStart_us, 0));
  fusion.add_frame(builder.view(0, std::numeric_limits<std::int64_t>::max(), 1));
  const auto result = fusion.add_frame(builder.view(0, kStart_us + 2 * kPeriod_us, 2));
  EXPECT_EQ(fusion.counters().recordings, 2);
  ASSERT_EQ(result.clouds.size(), 1U);
  EXPECT_EQ(result.clouds[0].utime_us, kStart_us + 2 * kPeriod_us);
}

// The bound holds for every size, the points are spread evenly over the heads and their images.
TEST(Fusion, CloudsAreBoundedEvenly) {
  for (const int max_points : {1, 2, 999, 1000, 1001, 3199, 3200, 3201, 5000}) {
    tof::TofParams params = one_head();
    params.max_points = max_points;
    tof::Fusion fusion(params);
    FrameBuilder builder(40, 40, 1000);
    fusion.add_frame(builder.view(0, kStart_us, 0));
    fusion.add_frame(builder.view(1, kStart_us + 1, 0));
    const auto result = fusion.add_frame(builder.view(0, kStart_us + kPeriod_us, 1));
    ASSERT_EQ(result.clouds.size(), 1U);
    const tof::Cloud& cloud = result.clouds[0];
    EXPECT_EQ(cloud.size(), static_cast<std::size_t>(std::min(max_points, 3200)));
    const auto first = std::count(cloud.head.begin(), cloud.head.end(), 0);
    EXPECT_LE(std::abs(2 * first - static_cast<std::ptrdiff_t>(cloud.size())), 1);
  }
}

// The same inputs give the same bits, whatever the object did before.
TEST(Fusion, SameInputsSameBits) {
  base::Rng rng(12);
  FrameBuilder builder(64, 48, 1000);
  for (auto& d : builder.depth_mm) d = static_cast<std::int16_t>(980 + rng.below(40));
  builder.frame.depth_kind = tof::DepthKind::kRadial;
  tof::TofParams params = one_head();
  params.max_points = 1000;
  tof::Fusion used(params);
  FrameBuilder other(100, 80, 2000);
  for (int i = 0; i < 5; ++i) used.add_frame(other.view(0, kStart_us + kPeriod_us * i, i));
  used.reset();
  tof::Fusion fresh(params);
  add_rest(used, kStart_us, Eigen::Vector3d(0.6, 0.0, 0.8));
  add_rest(fresh, kStart_us, Eigen::Vector3d(0.6, 0.0, 0.8));
  const auto a = used.add_frame(builder.view(0, kStart_us, 0));
  const auto b = fresh.add_frame(builder.view(0, kStart_us, 0));
  ASSERT_EQ(a.clouds.size(), 1U);
  ASSERT_EQ(a.clouds[0].size(), 1000U);
  EXPECT_EQ(std::memcmp(a.clouds[0].x_m.data(), b.clouds[0].x_m.data(), 4000), 0);
  EXPECT_EQ(std::memcmp(a.clouds[0].y_m.data(), b.clouds[0].y_m.data(), 4000), 0);
  EXPECT_EQ(std::memcmp(a.clouds[0].z_m.data(), b.clouds[0].z_m.data(), 4000), 0);
}

// These bits were computed once: another compiler or CPU must find the same.
TEST(Fusion, BitsAreTheSameEverywhere) {
  base::Rng rng(99);
  FrameBuilder builder(224, 171, 0);
  for (auto& d : builder.depth_mm) d = static_cast<std::int16_t>(1000 + rng.below(60));
  builder.frame.depth_kind = tof::DepthKind::kRadial;
  builder.frame.intrinsics = {186.4, 206.4, 111.5, 85.0};
  tof::Fusion fusion{one_head()};
  std::uint64_t hash = 1469598103934665603ULL;  // FNV-1a
  for (int i = 0; i < 6; ++i) {
    fusion.add_imu({kStart_us + kPeriod_us * i,
                    {3.0 + rng.gaussian(), rng.gaussian(), 9.0},
                    {rng.gaussian(), rng.gaussian(), rng.gaussian()}});
    const auto result = fusion.add_frame(builder.view(0, kStart_us + kPeriod_us * i, i));
    ASSERT_EQ(result.clouds.size(), 1U);
    for (const auto* coordinates :
         {&result.clouds[0].x_m, &result.clouds[0].y_m, &result.clouds[0].z_m}) {
      for (const float value : *coordinates) {
        std::uint32_t bits = 0;
        std::memcpy(&bits, &value, sizeof bits);
        hash = (hash ^ bits) * 1099511628211ULL;
      }
    }
  }
  EXPECT_EQ(hash, 4572409701652873625ULL);
}

}  // namespace
