// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <gtest/gtest.h>

#include "ladder_service/service.h"
#include "tests/support/service_harness.h"

namespace {

using ladder_msgs::health_t;
using ladder_msgs::ladder_t;
using ladder_msgs::topology_t;
namespace channels = runtime::channels;

constexpr std::int64_t kStart = 1'000'000'000;
constexpr std::int64_t kPeriod = 66'667;

topology_t empty_topology(std::int64_t seq) {
  topology_t m{};
  m.utime = kStart + seq * kPeriod;
  m.seq = seq;
  m.cloud_seq = seq;
  m.head_state[0] = ladder_msgs::point_cloud_t::HEAD_LIVE;
  m.q_odom_body[0] = 1.0F;
  m.range_max_m = 4.0F;
  m.pixel_pitch_rad = 0.005F;
  return m;
}

/// A node with the moments of 20 points around it.
void add_node(topology_t& m, float x, float y, float z) {
  const int index = m.num_nodes++;
  m.node_id.push_back(index);
  m.node_x_m.push_back(x);
  m.node_y_m.push_back(y);
  m.node_z_m.push_back(z);
  m.node_strength.push_back(1.0F);
  m.node_error_m2.push_back(0.0F);
  m.node_utility_m2.push_back(0.0F);
  m.node_class.push_back(topology_t::CLASS_OBSTACLE);
  m.node_object.push_back(-1);
  m.node_plane.push_back(-1);
  ++m.num_moments;
  m.moment_node.push_back(index);
  m.moment_head.push_back(0);
  m.moment_weight.push_back(20.0F);
  m.moment_x_m.push_back(x);
  m.moment_y_m.push_back(y);
  m.moment_z_m.push_back(z);
  for (auto* diagonal : {&m.moment_xx_m2, &m.moment_yy_m2, &m.moment_zz_m2})
    diagonal->push_back(3e-5F);
  for (auto* mixed : {&m.moment_xy_m2, &m.moment_xz_m2, &m.moment_yz_m2}) mixed->push_back(0.0F);
}

/// Two rails 0.44 m apart and five rungs 0.3 m apart, 1 m ahead of the head.
topology_t ladder_topology(std::int64_t seq) {
  topology_t m = empty_topology(seq);
  for (float z = -0.1F; z < 1.5F; z += 0.02F) {
    add_node(m, 1.0F, -0.22F, z);
    add_node(m, 1.0F, 0.22F, z);
  }
  for (int rung = 0; rung < 5; ++rung) {
    for (float y = -0.2F; y < 0.21F; y += 0.02F)
      add_node(m, 1.0F, y, 0.1F + 0.3F * static_cast<float>(rung));
  }
  return m;
}

class LadderService : public ::testing::Test {
 protected:
  const ladder_t* send(const topology_t& topology) {
    harness_.outside.publish(channels::kTopology, topology);
    harness_.step(topology.utime);
    return ladders_.take(0);
  }

  support::ServiceHarness harness_{ladder_service::description()};
  runtime::Queue<ladder_t>& ladders_ = harness_.outside.queue(channels::kRungs, 8);
};

// Without input nothing is published.
TEST_F(LadderService, Silence) {
  for (int i = 0; i < 50; ++i) harness_.step(kStart + i * 50'000);
  EXPECT_EQ(ladders_.take(0), nullptr);
  EXPECT_EQ(harness_.report().state, health_t::STATE_WAITING);
}

// An empty topology and one node are answered: no ladder.
TEST_F(LadderService, NothingToSee) {
  const ladder_t* ladder = send(empty_topology(0));
  ASSERT_NE(ladder, nullptr);
  EXPECT_EQ(ladder->num_rungs, 0);
  EXPECT_EQ(ladder->ladder_state, ladder_t::LADDER_NONE);
  topology_t one = empty_topology(1);
  add_node(one, 1.0F, 0.0F, 0.5F);
  ladder = send(one);
  ASSERT_NE(ladder, nullptr);
  EXPECT_EQ(ladder->num_rungs, 0);
}

// A ladder is confirmed within a few frames: five trusted rungs 0.3 m apart, two rails, time and
// number copied; after a second of frames there is a grasp on each.
TEST_F(LadderService, LadderIsConfirmed) {
  const ladder_t* ladder = nullptr;
  for (int seq = 0; seq < 8; ++seq) ladder = send(ladder_topology(seq));
  ASSERT_NE(ladder, nullptr);
  EXPECT_EQ(ladder->utime, kStart + 7 * kPeriod);
  EXPECT_EQ(ladder->topology_seq, 7);
  EXPECT_EQ(ladder->ladder_state, ladder_t::LADDER_CONFIRMED);
  EXPECT_NEAR(ladder->spacing_m, 0.3F, 0.01F);
  EXPECT_EQ(ladder->num_rails, 2);
  ASSERT_EQ(ladder->num_rungs, 5);
  EXPECT_EQ(ladder->num_grasps, 0) << "heads may prove to be badly mounted yet";
  for (int i = 0; i < ladder->num_rungs; ++i) {
    EXPECT_EQ(ladder->rung_state[i], ladder_t::RUNG_TRUSTED);
    EXPECT_NEAR(ladder->rung_z0_m[i], 0.1F + 0.3F * static_cast<float>(i), 0.02F);
    EXPECT_GT(ladder->rung_y0_m[i], ladder->rung_y1_m[i]) << "end 0 is the left one";
    EXPECT_GT(ladder->rung_cov_xx_m2[i], 0.0F);
  }
  for (int seq = 8; seq < 15; ++seq) ladder = send(ladder_topology(seq));
  ASSERT_EQ(ladder->num_grasps, 5);
  EXPECT_GT(ladder->grasp_approach_x[0], 0.99F);
}

// Each rung's offers and refusals stay on the rung, in ascending order, and every refusal has a
// reason.
TEST_F(LadderService, IntervalsAreOrderedAndExplained) {
  const ladder_t* ladder = nullptr;
  for (int seq = 0; seq < 20; ++seq) ladder = send(ladder_topology(seq));
  ASSERT_NE(ladder, nullptr);
  ASSERT_GT(ladder->num_intervals, 0);
  for (int i = 0; i < ladder->num_intervals; ++i) {
    const int rung = ladder->interval_rung[i];
    const float length = std::hypot(std::hypot(ladder->rung_x1_m[rung] - ladder->rung_x0_m[rung],
                                               ladder->rung_y1_m[rung] - ladder->rung_y0_m[rung]),
                                    ladder->rung_z1_m[rung] - ladder->rung_z0_m[rung]);
    EXPECT_GE(ladder->interval_from_m[i], 0.0F);
    EXPECT_LT(ladder->interval_from_m[i], ladder->interval_to_m[i]);
    EXPECT_LE(ladder->interval_to_m[i], length + 1e-3F);
    EXPECT_NE(ladder->interval_reason[i], ladder_t::REASON_UNKNOWN);
    if (i == 0 || ladder->interval_rung[i - 1] != rung) continue;
    EXPECT_GE(ladder->interval_from_m[i], ladder->interval_to_m[i - 1] - 1e-4F);
  }
}

// Time that goes backwards begins another recording: no rung of the one before survives.
TEST_F(LadderService, NewRecordingForgets) {
  for (int seq = 0; seq < 8; ++seq) send(ladder_topology(seq));
  topology_t other = empty_topology(0);
  other.utime = kStart - 60'000'000;
  const ladder_t* ladder = send(other);
  ASSERT_NE(ladder, nullptr);
  EXPECT_EQ(ladder->num_rungs, 0);
}

// A ladder that is no longer seen is no longer trusted.
TEST_F(LadderService, LadderThatVanishes) {
  for (int seq = 0; seq < 8; ++seq) send(ladder_topology(seq));
  const ladder_t* ladder = nullptr;
  for (int seq = 8; seq < 40; ++seq) ladder = send(empty_topology(seq));
  ASSERT_NE(ladder, nullptr);
  EXPECT_NE(ladder->ladder_state, ladder_t::LADDER_CONFIRMED);
  EXPECT_EQ(ladder->num_grasps, 0);
}

}  // namespace
