// SPDX-License-Identifier: BSD-3-Clause
#include "ddgng/attention.h"

#include <gtest/gtest.h>

#include "tests/ddgng/structure_scene.h"

namespace ddgng {
namespace {

structure_scene::Cloud random_cloud(int num_points) {
  structure_scene::Cloud cloud;
  base::Rng rng(9);
  for (int i = 0; i < num_points; ++i) {
    cloud.add({static_cast<float>(5.0 * rng.uniform() - 0.5),
               static_cast<float>(3.0 * rng.uniform() - 1.5),
               static_cast<float>(3.0 * rng.uniform() - 0.5)});
  }
  return cloud;
}

Topology planes_and_boxes() {
  Topology topology;
  topology.planes.push_back({Eigen::Vector3f::UnitZ(), 0.0F, Class::kSafeGround});
  topology.planes.push_back({-Eigen::Vector3f::UnitX(), -2.0F, Class::kWall});
  topology.objects.push_back({{1, 0, 1}, {0.2F, 0.4F, 1.0F}, Eigen::Vector3f::Zero(), true});
  topology.objects.push_back({{1.2F, 0.3F, 1}, {0.4F, 0.4F, 0.4F}, Eigen::Vector3f::Zero(), true});
  topology.objects.push_back({{3, 0, 1}, {1, 1, 1}, Eigen::Vector3f::Zero(), false});
  return topology;
}

// Nothing seen, nothing selected.
TEST(Attention, EmptyCloud) {
  for (const StructureParams& params : {StructureParams(), paper_structure_params()}) {
    Attention attention(params, 10);
    const structure_scene::Cloud cloud;
    attention.set_regions(Topology(), cloud.view());
    EXPECT_TRUE(attention.select(cloud.view()).empty());
  }
}

// Before any plane is known, the whole workspace draws attention; boxes select nothing.
TEST(Attention, BeforeTheFirstStructure) {
  const structure_scene::Cloud cloud = random_cloud(1000);
  Attention off_planes(StructureParams(), 1000);
  off_planes.set_regions(Topology(), cloud.view());
  EXPECT_GT(off_planes.select(cloud.view()).size(), 300U);
  Attention boxes(paper_structure_params(), 1000);
  boxes.set_regions(Topology(), cloud.view());
  EXPECT_TRUE(boxes.select(cloud.view()).empty());
}

// The workspace turns with the robot: what lies ahead of it draws attention, what lies beside it
// does not.
TEST(Attention, WorkspaceTurnsWithTheRobot) {
  structure_scene::Cloud cloud;
  cloud.add({2.0F, 0.0F, 0.5F});
  cloud.add({0.0F, 2.0F, 0.5F});
  for (const bool turned : {false, true}) {
    Attention attention(StructureParams(), 2);
    CloudView view = cloud.view();
    if (turned) view.ahead = Eigen::Vector2f::UnitY();
    attention.set_regions(Topology(), view);
    const auto selected = attention.select(view);
    ASSERT_EQ(selected.size(), 1U);
    EXPECT_EQ(selected[0], turned ? 1U : 0U);
    EXPECT_EQ(attention.contains({2.0F, 0.0F, 0.5F}), !turned);
    EXPECT_EQ(attention.contains({0.0F, 2.0F, 0.5F}), turned);
  }
}

// With equal margins, a point is selected exactly when a node there would be strong: the fast loop
// agrees with the plain condition, at all block lengths.
TEST(Attention, SelectAgreesWithContains) {
  for (StructureParams params : {StructureParams(), paper_structure_params()}) {
    params.sample_margin_m = params.strength_margin_m;
    for (const int num_points : {1, 255, 256, 257, 5000}) {
      const structure_scene::Cloud cloud = random_cloud(num_points);
      Attention attention(params, 5000);
      attention.set_regions(planes_and_boxes(), cloud.view());
      std::vector<std::uint32_t> expected;
      for (int i = 0; i < num_points; ++i) {
        if (attention.contains({cloud.x_m[i], cloud.y_m[i], cloud.z_m[i]})) expected.push_back(i);
      }
      const auto selected = attention.select(cloud.view());
      EXPECT_EQ(std::vector<std::uint32_t>(selected.begin(), selected.end()), expected);
      if (num_points == 5000) {
        EXPECT_GT(expected.size(), 20U);
      }
    }
  }
}

// The workspace goes with the heads.
TEST(Attention, WorkspaceFollowsTheHeads) {
  const structure_scene::Cloud cloud;
  CloudView view = cloud.view();
  Attention attention(StructureParams(), 1);
  attention.set_regions(Topology(), view);
  EXPECT_TRUE(attention.contains({1, 0.7F, 1}));
  EXPECT_FALSE(attention.contains({0.1F, 0, 1}));
  EXPECT_FALSE(attention.contains({1, 0.9F, 1}));
  EXPECT_FALSE(attention.contains({4.1F, 0, 1}));
  for (auto& head_m : view.head_position_m) head_m += Eigen::Vector3f(-1, 1, 3);
  attention.set_regions(Topology(), view);
  EXPECT_TRUE(attention.contains({0.1F, 0.3F, 4}));
  EXPECT_FALSE(attention.contains({1, 0.1F, 1}));
}

// When all heads fall silent, the workspace stays where they were.
TEST(Attention, SilentHeadsLeaveTheWorkspace) {
  const structure_scene::Cloud cloud;
  CloudView view = cloud.view();
  Attention attention(StructureParams(), 1);
  for (auto& head_m : view.head_position_m) head_m.x() = 10.0F;
  attention.set_regions(Topology(), view);
  view.head_valid.fill(false);
  view.head_position_m.fill(Eigen::Vector3f::Zero());
  attention.set_regions(Topology(), view);
  EXPECT_TRUE(attention.contains({12, 0, 1}));
}

// Below the lowest safe ground nothing draws attention; neither a table's top nor a
// plane of another class counts as floor.
TEST(Attention, NothingBelowTheFloor) {
  const structure_scene::Cloud cloud;
  const Plane table{Eigen::Vector3f::UnitZ(), 0.4F, Class::kSafeGround};
  const Plane floor{Eigen::Vector3f::UnitZ(), -0.2F, Class::kSafeGround};
  const Plane shaft{Eigen::Vector3f::UnitZ(), -2.0F, Class::kObstacle};
  Attention attention(StructureParams(), 1);
  Topology topology;
  for (const auto& planes : {std::vector{table, floor, shaft}, std::vector{shaft, floor, table}}) {
    topology.planes = planes;
    attention.set_regions(topology, cloud.view());
    EXPECT_TRUE(attention.contains({1, 0, 0.1F}));
    EXPECT_FALSE(attention.contains({1, 0, -0.5F}));
  }
  attention.set_regions(Topology(), cloud.view());
  EXPECT_TRUE(attention.contains({1, 0, -0.5F}));
}

// A cloud above the capacity is our own bug.
TEST(AttentionDeathTest, CloudAboveCapacity) {
  Attention attention(StructureParams(), 10);
  const structure_scene::Cloud cloud = random_cloud(11);
  EXPECT_DEATH(attention.select(cloud.view()), "capacity");
}

}  // namespace
}  // namespace ddgng
