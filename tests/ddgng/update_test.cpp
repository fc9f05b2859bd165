// SPDX-License-Identifier: BSD-3-Clause
// Whole frames: odd clouds, the shape of the output, the same bits again, density where it belongs.
#include <algorithm>
#include <cstring>
#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "ddgng/ddgng.h"
#include "room.h"

namespace ddgng {
namespace {

DdgngParams small() {
  DdgngParams params;
  params.growing.max_nodes = 400;
  params.growing.max_plane_nodes = 150;
  params.growing.uniform_signals = 400;
  params.growing.attention_signals = 1600;
  return params;
}

void expect_sound(const Topology& t, const GrowingParams& params) {
  const int num_nodes = t.num_nodes();
  ASSERT_LE(num_nodes, params.max_nodes);
  ASSERT_EQ(t.node_x_m.size(), t.node_id.size());
  ASSERT_EQ(t.node_strength.size(), t.node_id.size());
  for (int i = 0; i < num_nodes; ++i) {
    ASSERT_TRUE(i == 0 || t.node_id[i - 1] < t.node_id[i]);
    ASSERT_TRUE(t.node_m(i).allFinite());
    ASSERT_GE(t.node_error_m2[i], 0.0F);
    ASSERT_GE(t.node_utility_m2[i], 0.0F);
    ASSERT_TRUE(t.node_strength[i] == params.strength_outside ||
                t.node_strength[i] == params.strength_inside);
  }
  std::vector<int> degree(num_nodes);
  for (std::size_t k = 0; k < t.edges.size(); ++k) {
    const Edge& e = t.edges[k];
    ASSERT_TRUE(0 <= e.a && e.a < e.b && e.b < num_nodes);
    ++degree[e.a];
    ++degree[e.b];
    if (k == 0) continue;
    const Edge& before = t.edges[k - 1];
    ASSERT_TRUE(before.a < e.a || (before.a == e.a && before.b < e.b));
  }
  for (const int d : degree) ASSERT_LE(d, params.max_degree);
  for (std::size_t k = 0; k < t.moments.size(); ++k) {
    const Moment& m = t.moments[k];
    ASSERT_TRUE(0 <= m.node && m.node < num_nodes && 0 <= m.head && m.head < kNumHeads);
    ASSERT_GE(m.weight, params.min_moment_weight);
    ASSERT_TRUE(m.mean_m.allFinite());
    if (k == 0) continue;
    const Moment& before = t.moments[k - 1];
    ASSERT_TRUE(before.node < m.node || (before.node == m.node && before.head < m.head));
  }
}

template <typename T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

void expect_same_bits(const Topology& a, const Topology& b) {
  EXPECT_TRUE(same_bits(a.node_id, b.node_id));
  EXPECT_TRUE(same_bits(a.node_x_m, b.node_x_m));
  EXPECT_TRUE(same_bits(a.node_y_m, b.node_y_m));
  EXPECT_TRUE(same_bits(a.node_z_m, b.node_z_m));
  EXPECT_TRUE(same_bits(a.node_strength, b.node_strength));
  EXPECT_TRUE(same_bits(a.node_error_m2, b.node_error_m2));
  EXPECT_TRUE(same_bits(a.node_utility_m2, b.node_utility_m2));
  EXPECT_TRUE(same_bits(a.node_class, b.node_class));
  EXPECT_TRUE(same_bits(a.node_object, b.node_object));
  EXPECT_TRUE(same_bits(a.node_plane, b.node_plane));
  EXPECT_TRUE(same_bits(a.moments, b.moments));
  EXPECT_TRUE(same_bits(a.edges, b.edges));
  EXPECT_TRUE(same_bits(a.faces, b.faces));
}

Room points(std::vector<float> x, std::vector<float> y, std::vector<float> z) {
  Room room;
  room.head.assign(x.size(), 0);
  room.x_m = std::move(x);
  room.y_m = std::move(y);
  room.z_m = std::move(z);
  return room;
}

int nodes_on_ladder(const Topology& t) {
  int num = 0;
  for (int i = 0; i < t.num_nodes(); ++i) num += on_ladder(t.node_m(i)) ? 1 : 0;
  return num;
}

// Nothing and a single point start nothing; two points do.
TEST(Update, FirstTwoPoints) {
  DynamicDensityGng gng(small());
  EXPECT_EQ(gng.update(Room{}.view(0)).num_nodes(), 0);
  EXPECT_EQ(gng.update(points({1}, {1}, {1}).view(1)).num_nodes(), 0);
  const Topology& t = gng.update(points({1, 2}, {1, 2}, {1, 2}).view(2));
  EXPECT_GE(t.num_nodes(), 2);
  expect_sound(t, small().growing);
}

// Identical points, also very many nodes on one place, are no trouble.
TEST(Update, IdenticalPoints) {
  DynamicDensityGng gng(small());
  const Room room =
      points(std::vector<float>(50, 1), std::vector<float>(50, 2), std::vector<float>(50, 3));
  for (int frame = 0; frame < 5; ++frame)
    expect_sound(gng.update(room.view(frame)), small().growing);
}

// Points that are not finite never enter a node.
TEST(Update, BrokenPoints) {
  DynamicDensityGng gng(small());
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  const Room room = points({nan, inf, 1, 2, 1}, {1, 1, 2, 3, 1e30F}, {1, 1, -inf, 1, 1});
  for (int frame = 0; frame < 5; ++frame)
    expect_sound(gng.update(room.view(frame)), small().growing);
}

// An empty cloud in between leaves the nodes and edges as they are.
TEST(Update, EmptyCloudKeepsTheNodes) {
  DynamicDensityGng gng(small());
  const Room room = RoomBuilder(1).build(20000);
  for (int frame = 0; frame < 3; ++frame) gng.update(room.view(frame));
  const Topology before = gng.topology();
  const Topology& t = gng.update(Room{}.view(3));
  EXPECT_TRUE(same_bits(t.node_id, before.node_id));
  EXPECT_TRUE(same_bits(t.node_x_m, before.node_x_m));
  EXPECT_TRUE(same_bits(t.edges, before.edges));
  expect_sound(t, small().growing);
}

// Every frame of a room is a sound topology within the bounds, for several seeds and both modes.
TEST(Update, SoundTopologies) {
  for (const bool paper : {false, true}) {
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
      DdgngParams params = small();
      if (paper) params.growing = paper_params();
      if (paper) params.structure = paper_structure_params();
      params.growing.seed = seed;
      params.growing.max_degree = 8;
      DynamicDensityGng gng(params);
      const Room room = RoomBuilder(seed).build(20000);
      for (int frame = 0; frame < 8; ++frame) {
        expect_sound(gng.update(room.view(frame)), params.growing);
        if (HasFatalFailure()) return;
      }
    }
  }
}

// The same clouds give the same bits again: after reset(), and in a second instance.
TEST(Update, Repeats) {
  const Room room = RoomBuilder(2).build(20000);
  DynamicDensityGng first(small());
  DynamicDensityGng second(small());
  for (int frame = 0; frame < 4; ++frame) second.update(room.view(100 + frame));
  second.reset();
  EXPECT_EQ(second.topology().num_nodes(), 0);
  for (int frame = 0; frame < 4; ++frame) {
    expect_same_bits(first.update(room.view(frame)), second.update(room.view(frame)));
  }
}

// Every instruction set of this machine gives the same bits.
TEST(Update, SameBitsOnEveryInstructionSet) {
  const Room room = RoomBuilder(3).build(20000);
  const auto run = [&room](std::int64_t target) {
    hwy::SetSupportedTargetsForTest(target);
    DynamicDensityGng gng(small());
    for (int frame = 0; frame < 4; ++frame) gng.update(room.view(frame));
    hwy::SetSupportedTargetsForTest(0);
    return gng.topology();
  };
  const Topology expected = run(0);
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    expect_same_bits(expected, run(target));
  }
}

// Density: within five frames the ladder has several times the nodes that equal work without
// density gives it.
TEST(Update, LadderGetsTheNodes) {
  const Room room = RoomBuilder(4).build(60000);
  DdgngParams plain;
  plain.growing.strength_inside = 1.0F;
  plain.growing.attention_signals = 0;
  plain.growing.uniform_signals = 5000;
  DynamicDensityGng dense(DdgngParams{});
  DynamicDensityGng uniform(plain);
  for (int frame = 0; frame < 5; ++frame) {
    dense.update(room.view(frame));
    uniform.update(room.view(frame));
  }
  RecordProperty("dense", nodes_on_ladder(dense.topology()));
  RecordProperty("uniform", nodes_on_ladder(uniform.topology()));
  EXPECT_GT(nodes_on_ladder(dense.topology()), 2 * nodes_on_ladder(uniform.topology()));
}

// Without a suspected area nodes stop at the bound for planes instead of filling the graph.
TEST(Update, PlaneNodesAreBounded) {
  DdgngParams params;
  params.structure.attention = AttentionMode::kBoxes;
  params.structure.max_object_width_m = 1e-3F;  // nothing is ever suspected
  DynamicDensityGng gng(params);
  const Room room = RoomBuilder(5).build(20000);
  for (int frame = 0; frame < 5; ++frame) gng.update(room.view(frame));
  EXPECT_EQ(gng.num_suspected_points(), 0U);
  EXPECT_EQ(gng.topology().num_nodes(), params.growing.max_plane_nodes);
}

}  // namespace
}  // namespace ddgng
