// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "base/rng.h"
#include "gng_service/service.h"
#include "tests/support/service_harness.h"

namespace {

using ladder_msgs::health_t;
using ladder_msgs::point_cloud_t;
using ladder_msgs::topology_t;
namespace channels = runtime::channels;

constexpr std::int64_t kStart = 1'000'000'000;
constexpr std::int64_t kPeriod = 66'667;

/// num_points on a wall 1.5 m ahead.
point_cloud_t wall_cloud(std::int64_t seq, std::int64_t utime, int num_points) {
  point_cloud_t m{};
  m.utime = utime;
  m.seq = seq;
  m.head_utime[1] = utime;
  m.head_state[1] = point_cloud_t::HEAD_LIVE;
  m.q_odom_body[0] = 1.0F;
  m.pose_source = point_cloud_t::POSE_GRAVITY;
  m.range_max_m = 4.0F;
  m.pixel_pitch_rad = 0.005F;
  m.num_points = num_points;
  base::Rng rng(7, static_cast<std::uint64_t>(seq));
  for (int i = 0; i < num_points; ++i) {
    m.x_m.push_back(1.5F);
    m.y_m.push_back(static_cast<float>(2.0 * rng.uniform() - 1.0));
    m.z_m.push_back(static_cast<float>(2.0 * rng.uniform() - 1.0));
    m.head.push_back(1);
  }
  return m;
}

class GngService : public ::testing::Test {
 protected:
  const topology_t* send(const point_cloud_t& cloud) {
    harness_.outside.publish(channels::kCloud, cloud);
    harness_.step(cloud.utime);
    return topologies_.take(0);
  }

  support::ServiceHarness harness_{gng_service::description()};
  runtime::Queue<topology_t>& topologies_ = harness_.outside.queue(channels::kTopology, 8);
};

// Without input nothing is published.
TEST_F(GngService, Silence) {
  for (int i = 0; i < 50; ++i) harness_.step(kStart + i * 50'000);
  EXPECT_EQ(topologies_.take(0), nullptr);
  EXPECT_EQ(harness_.report().state, health_t::STATE_WAITING);
}

// An empty cloud, one point and two points are answered with a valid topology, not with silence or
// a crash.
TEST_F(GngService, TinyClouds) {
  for (int i = 0; i < 6; ++i) {
    const topology_t* topology = send(wall_cloud(i, kStart + i * kPeriod, i % 3));
    ASSERT_NE(topology, nullptr) << i << " points";
    EXPECT_EQ(topology->cloud_seq, i);
  }
}

// What a receiver needs of the cloud is copied: time, number, heads, body, ranges.
TEST_F(GngService, CopiesTheCloudsOrigin) {
  point_cloud_t cloud = wall_cloud(41, kStart, 2'000);
  cloud.head_x_m[1] = 0.25F;
  cloud.p_odom_body_m[2] = -0.5F;
  const topology_t* topology = send(cloud);
  ASSERT_NE(topology, nullptr);
  EXPECT_EQ(topology->utime, kStart);
  EXPECT_EQ(topology->cloud_seq, 41);
  EXPECT_EQ(topology->head_state[1], point_cloud_t::HEAD_LIVE);
  EXPECT_EQ(topology->head_x_m[1], 0.25F);
  EXPECT_EQ(topology->p_odom_body_m[2], -0.5F);
  EXPECT_EQ(topology->range_max_m, 4.0F);
  EXPECT_EQ(topology->pixel_pitch_rad, 0.005F);
}

// A wall becomes nodes on the wall, labelled wall, with the moments of the points they won.
TEST_F(GngService, WallIsWall) {
  const topology_t* topology = nullptr;
  for (int i = 0; i < 10; ++i) topology = send(wall_cloud(i, kStart + i * kPeriod, 5'000));
  ASSERT_NE(topology, nullptr);
  ASSERT_GE(topology->num_nodes, 100);
  int num_wall = 0;
  for (int i = 0; i < topology->num_nodes; ++i) {
    EXPECT_NEAR(topology->node_x_m[i], 1.5F, 1e-3F);
    num_wall += topology->node_class[i] == topology_t::CLASS_WALL;
  }
  EXPECT_GE(num_wall, topology->num_nodes * 9 / 10);
  ASSERT_GE(topology->num_moments, 50);
  EXPECT_EQ(topology->moment_head[0], 1);
  EXPECT_NEAR(topology->moment_x_m[0], 1.5F, 1e-3F);
}

// The newest cloud wins: of three that arrive before the work step one is used and two are counted
// as overwritten.
TEST_F(GngService, NewestCloudWins) {
  for (int i = 0; i < 3; ++i)
    harness_.outside.publish(channels::kCloud, wall_cloud(i, kStart + i * kPeriod, 100));
  harness_.step(kStart + 3 * kPeriod);
  const topology_t* topology = topologies_.take(0);
  ASSERT_NE(topology, nullptr);
  EXPECT_EQ(topology->cloud_seq, 2);
  EXPECT_EQ(topologies_.take(0), nullptr);
  EXPECT_EQ(harness_.report().input_overwritten[0], 2);
}

// Time that goes backwards begins another recording: the nodes of the one before are gone.
TEST_F(GngService, NewRecordingForgets) {
  for (int i = 0; i < 10; ++i) send(wall_cloud(i, kStart + i * kPeriod, 5'000));
  point_cloud_t other = wall_cloud(0, kStart - 60'000'000, 5'000);
  for (float& x : other.x_m) x = 3.0F;
  const topology_t* topology = send(other);
  ASSERT_NE(topology, nullptr);
  for (int i = 0; i < topology->num_nodes; ++i) EXPECT_NEAR(topology->node_x_m[i], 3.0F, 1e-3F);
}

// The same clouds give the same topology in another process: nothing but configuration and input
// matters.
TEST_F(GngService, SameInputSameOutput) {
  support::ServiceHarness other{gng_service::description()};
  auto& other_topologies = other.outside.queue(channels::kTopology, 8);
  for (int i = 0; i < 5; ++i) {
    const point_cloud_t cloud = wall_cloud(i, kStart + i * kPeriod, 3'000);
    const topology_t* a = send(cloud);
    other.outside.publish(channels::kCloud, cloud);
    other.step(cloud.utime + 12'345);  // when it works must not matter
    const topology_t* b = other_topologies.take(0);
    ASSERT_NE(a, nullptr);
    ASSERT_NE(b, nullptr);
    EXPECT_EQ(a->node_x_m, b->node_x_m);
    EXPECT_EQ(a->node_y_m, b->node_y_m);
    EXPECT_EQ(a->edge_a, b->edge_a);
    EXPECT_EQ(a->moment_xx_m2, b->moment_xx_m2);
  }
}

// A cloud larger than the configured bound is left out; the next one is used.
TEST(GngServiceBound, TooLargeCloudIsLeftOut) {
  support::ServiceHarness harness{gng_service::description(), {"gng.max_points=1000"}};
  auto& topologies = harness.outside.queue(channels::kTopology, 8);
  harness.outside.publish(channels::kCloud, wall_cloud(0, kStart, 1'001));
  harness.step(kStart);
  EXPECT_EQ(topologies.take(0), nullptr);
  harness.outside.publish(channels::kCloud, wall_cloud(1, kStart + kPeriod, 1'000));
  harness.step(kStart + kPeriod);
  EXPECT_NE(topologies.take(0), nullptr);
}

// The paper's literal mode runs on the same door: two insertions a frame.
TEST(GngServicePaper, TwoInsertionsPerFrame) {
  support::ServiceHarness harness{gng_service::description(), {"gng.mode=paper"}};
  auto& topologies = harness.outside.queue(channels::kTopology, 8);
  for (int i = 0; i < 10; ++i) {
    harness.outside.publish(channels::kCloud, wall_cloud(i, kStart + i * kPeriod, 2'000));
    harness.step(kStart + i * kPeriod);
    const topology_t* topology = topologies.take(0);
    ASSERT_NE(topology, nullptr);
    EXPECT_LE(topology->num_nodes, 2 + 2 * (i + 1));
  }
}

}  // namespace
