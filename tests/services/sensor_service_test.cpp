// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include <gtest/gtest.h>

#include "sensor_service/service.h"
#include "tests/support/service_harness.h"

namespace {

using ladder_msgs::health_t;
using ladder_msgs::point_cloud_t;
using ladder_msgs::tof_frame_t;
namespace channels = runtime::channels;

constexpr std::int64_t kStart = 1'000'000'000;
constexpr std::int64_t kPeriod = 66'667;
constexpr std::int64_t kStagger = 16'667;

/// A head that looks along x at a wall 1 m away.
tof_frame_t frame(int head, std::int64_t seq, std::int64_t utime) {
  tof_frame_t m{};
  m.utime = utime;
  m.seq = seq;
  m.head = static_cast<std::int8_t>(head);
  m.depth_kind = tof_frame_t::DEPTH_Z;
  m.width_px = 8;
  m.height_px = 6;
  m.fx_px = m.fy_px = 8.0;
  m.cx_px = 3.5;
  m.cy_px = 2.5;
  m.range_min_m = 0.1;
  m.range_max_m = 4.0;
  const double q[4] = {0.5, -0.5, 0.5,
                       -0.5};  // image right = -y, image down = -z, optical axis = x
  std::copy(q, q + 4, m.q_body_head);
  m.num_pixels = 48;
  m.depth_mm.assign(48, 1000);
  return m;
}

ladder_msgs::imu_t level_imu(std::int64_t seq, std::int64_t utime) {
  ladder_msgs::imu_t m{};
  m.utime = utime;
  m.seq = seq;
  m.accelerometer_m_s2[2] = 9.81;
  return m;
}

class SensorService : public ::testing::Test {
 protected:
  /// One frame of each of these heads and an IMU sample before; steps after each message, as when
  /// they come one by one.
  void send_round(std::int64_t round, const std::vector<int>& heads) {
    const std::int64_t base = kStart + round * kPeriod;
    harness_.outside.publish(channels::kImu, level_imu(round, base - 5'000));
    harness_.step(base);
    for (const int head : heads) {
      const std::int64_t utime = base + head * kStagger;
      harness_.outside.publish(channels::kTof[head], frame(head, round, utime));
      harness_.step(utime);
    }
  }

  const point_cloud_t* next_cloud() { return clouds_.take(0); }

  support::ServiceHarness harness_{sensor_service::description()};
  runtime::Queue<point_cloud_t>& clouds_ = harness_.outside.queue(channels::kCloud, 256);
};

// Without input nothing is published and the state is "waiting".
TEST_F(SensorService, Silence) {
  for (int i = 0; i < 50; ++i) harness_.step(kStart + i * 50'000);
  EXPECT_EQ(next_cloud(), nullptr);
  EXPECT_EQ(harness_.report().state, health_t::STATE_WAITING);
}

// Four heads make one cloud with the newest head's time, none older than a period; the wall stands
// 1 m ahead, seen level.
TEST_F(SensorService, FourHeadsOneCloud) {
  send_round(0, {0, 1, 2, 3});
  send_round(1, {0, 1, 2, 3});
  const point_cloud_t* cloud = nullptr;
  int num_clouds = 0;
  while (const point_cloud_t* next = next_cloud()) {
    cloud = next;
    ++num_clouds;
  }
  ASSERT_GE(num_clouds, 2);
  ASSERT_NE(cloud, nullptr);
  EXPECT_EQ(cloud->utime, *std::max_element(cloud->head_utime, cloud->head_utime + 4));
  EXPECT_LT(cloud->utime - *std::min_element(cloud->head_utime, cloud->head_utime + 4), kPeriod);
  EXPECT_EQ(cloud->num_points, 4 * 48);
  for (int i = 0; i < cloud->num_points; ++i) EXPECT_NEAR(cloud->x_m[i], 1.0F, 1e-4F);
  EXPECT_EQ(cloud->pose_source, point_cloud_t::POSE_GRAVITY);
  EXPECT_EQ(harness_.report().state, health_t::STATE_WORKING);
  EXPECT_NE(harness_.report().flags & health_t::FLAG_NO_ODOMETRY, 0);
}

// seq of the clouds rises by one, whatever the heads' numbers do.
TEST_F(SensorService, SeqRisesByOne) {
  for (int round = 0; round < 5; ++round) send_round(3 * round, {0, 1, 2, 3});
  std::int64_t expected = 0;
  while (const point_cloud_t* cloud = next_cloud()) EXPECT_EQ(cloud->seq, expected++);
  EXPECT_GE(expected, 5);
}

// A head that falls silent degrades the service, is reported, and clouds go on; when it returns all
// is well again.
TEST_F(SensorService, DeadHeadAndItsReturn) {
  for (int round = 0; round < 5; ++round) send_round(round, {0, 1, 2, 3});
  for (int round = 5; round < 15; ++round) send_round(round, {0, 1, 3});
  EXPECT_EQ(harness_.report().state, health_t::STATE_DEGRADED);
  EXPECT_EQ(harness_.report().head_state[2], point_cloud_t::HEAD_DEAD);
  EXPECT_NE(harness_.report().flags & health_t::FLAG_HEAD_DEAD, 0);
  int after = 0;
  while (const point_cloud_t* cloud = next_cloud())
    after += cloud->head_state[2] == point_cloud_t::HEAD_DEAD;
  EXPECT_GE(after, 5);
  for (int round = 15; round < 18; ++round) send_round(round, {0, 1, 2, 3});
  EXPECT_EQ(harness_.report().state, health_t::STATE_WORKING);
  EXPECT_EQ(harness_.report().flags & health_t::FLAG_HEAD_DEAD, 0);
}

// A frame whose head number contradicts nothing on the wire but whose pixels do not fit is refused
// by the guard, not used.
TEST_F(SensorService, WrongPixelCountIsRefused) {
  send_round(0, {0, 1, 2, 3});
  while (next_cloud() != nullptr) {
  }
  tof_frame_t wrong = frame(0, 1, kStart + kPeriod);
  wrong.width_px = 9;
  harness_.outside.publish(channels::kTof[0], wrong);
  harness_.step(kStart + kPeriod);
  EXPECT_EQ(next_cloud(), nullptr);
  EXPECT_EQ(harness_.report().rejected_value, 1);
}

// The same frame twice counts once.
TEST_F(SensorService, DuplicateFrame) {
  send_round(0, {0, 1, 2, 3});
  while (next_cloud() != nullptr) {
  }
  harness_.outside.publish(channels::kTof[3], frame(3, 0, kStart + 3 * kStagger));
  harness_.step(kStart + kPeriod);
  EXPECT_EQ(next_cloud(), nullptr);
  EXPECT_EQ(harness_.report().rejected_stale, 1);
}

// With odometry the cloud stands in the odom frame.
TEST_F(SensorService, OdometryMovesTheCloud) {
  for (int round = 0; round < 4; ++round) {
    ladder_msgs::pose_t pose{};
    pose.utime = kStart + round * kPeriod - 1'000;
    pose.seq = round;
    pose.p_odom_body_m[0] = 5.0;
    pose.q_odom_body[0] = 1.0;
    harness_.outside.publish(channels::kPose, pose);
    send_round(round, {0, 1, 2, 3});
  }
  const point_cloud_t* cloud = nullptr;
  while (const point_cloud_t* next = next_cloud()) cloud = next;
  ASSERT_NE(cloud, nullptr);
  EXPECT_EQ(cloud->pose_source, point_cloud_t::POSE_ODOMETRY);
  EXPECT_NEAR(cloud->x_m[0], 6.0F, 1e-3F);
  EXPECT_NEAR(cloud->p_odom_body_m[0], 5.0F, 1e-3F);
}

}  // namespace
