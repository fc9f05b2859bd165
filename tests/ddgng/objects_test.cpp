// SPDX-License-Identifier: BSD-3-Clause
#include "ddgng/objects.h"

#include <gtest/gtest.h>

#include "tests/ddgng/structure_scene.h"

namespace ddgng {
namespace {

using structure_scene::make_topology;

/// A chain of obstacle nodes along y, 0.1 m apart, centred at p.
Topology chain_at(const Eigen::Vector3f& p, int num_nodes = 5) {
  std::vector<Eigen::Vector3f> nodes_m;
  std::vector<std::pair<int, int>> edges;
  for (int i = 0; i < num_nodes; ++i) {
    const float offset = 0.1F * (static_cast<float>(i) - 0.5F * static_cast<float>(num_nodes - 1));
    nodes_m.emplace_back(p + offset * Eigen::Vector3f::UnitY());
    if (i > 0) edges.emplace_back(i - 1, i);
  }
  Topology topology = make_topology(nodes_m, edges);
  topology.node_class.assign(num_nodes, Class::kObstacle);
  return topology;
}

CloudView cloud_at(float time_step_s) {
  static const structure_scene::Cloud cloud;
  CloudView view = cloud.view();
  view.time_step_s = time_step_s;
  return view;
}

Object only_object(ObjectFinder& finder, Topology topology, float time_step_s = 0.1F) {
  finder.build(cloud_at(time_step_s), topology);
  EXPECT_EQ(topology.objects.size(), 1U);
  return topology.objects.at(0);
}

// A chain in the moving space is one suspected object with the box of its nodes.
TEST(Objects, ChainInTheSpaceIsSuspected) {
  ObjectFinder finder(StructureParams(), 100, 100);
  const Object object = only_object(finder, chain_at({1, 0, 0.5F}));
  EXPECT_TRUE(object.suspected);
  EXPECT_NEAR(object.size_m.y(), 0.4F, 1e-6F);
  EXPECT_LT((object.center_m - Eigen::Vector3f(1, 0, 0.5F)).norm(), 1e-6F);
}

// Behind the heads, beside the space, or too wide: not suspected.
TEST(Objects, OthersAreNot) {
  StructureParams params;
  ObjectFinder finder(params, 100, 100);
  EXPECT_FALSE(only_object(finder, chain_at({-1, 0, 0.5F}), 0).suspected);
  EXPECT_FALSE(only_object(finder, chain_at({1, 1.5F, 0.5F}), 0).suspected);
  EXPECT_FALSE(only_object(finder, chain_at({4.5F, 0, 0.5F}), 0).suspected);
  EXPECT_FALSE(only_object(finder, chain_at({1, 0, 0.5F}, 40), 0).suspected);
  params.max_object_width_m = 5.0F;
  ObjectFinder tolerant(params, 100, 100);
  EXPECT_TRUE(only_object(tolerant, chain_at({1, 0, 0.5F}, 40), 0).suspected);
}

// The space turns with the heads: what was aside is ahead, and the other way round.
TEST(Objects, TheSpaceLiesWhereTheHeadsLook) {
  for (const auto& [p, suspected] :
       {std::pair(Eigen::Vector3f(0, 2, 0.5F), true), std::pair(Eigen::Vector3f(2, 0, 0.5F), false),
        std::pair(Eigen::Vector3f(0, -2, 0.5F), false)}) {
    Topology topology = chain_at(p);
    CloudView cloud = cloud_at(0);
    cloud.ahead = Eigen::Vector2f::UnitY();
    ObjectFinder finder(StructureParams(), 100, 100);
    finder.build(cloud, topology);
    EXPECT_EQ(topology.objects.at(0).suspected, suspected) << p.transpose();
  }
}

// What lies wholly below the known ground is not suspected.
TEST(Objects, BelowTheGroundIsNotSuspected) {
  for (const float z : {-0.2F, 0.2F}) {
    Topology topology = make_topology({{0.5F, 0, 0}, {1, 0, z}, {1, 0.1F, z}}, {{1, 2}});
    topology.node_class = {Class::kSafeGround, Class::kObstacle, Class::kObstacle};
    ObjectFinder finder(StructureParams(), 100, 100);
    finder.build(cloud_at(0), topology);
    ASSERT_EQ(topology.objects.size(), 1U);
    EXPECT_EQ(topology.objects[0].suspected, z > 0);
    EXPECT_EQ(topology.node_object, (std::vector<int>{-1, 0, 0}));
  }
}

// The velocity is the way of the box centre between frames; the first frame and a lost time step
// give none.
TEST(Objects, VelocityOfAMovingChain) {
  ObjectFinder finder(StructureParams(), 100, 100);
  EXPECT_EQ(only_object(finder, chain_at({1, 0, 0.5F})).velocity_m_s.norm(), 0.0F);
  const Object moved = only_object(finder, chain_at({1, 0.02F, 0.5F}));
  EXPECT_NEAR(moved.velocity_m_s.y(), 0.2F, 1e-5F);
  EXPECT_EQ(only_object(finder, chain_at({1, 0.5F, 0.5F}), 0.0F).velocity_m_s.norm(), 0.0F);
  finder.reset();
  EXPECT_EQ(only_object(finder, chain_at({1, 0.9F, 0.5F})).velocity_m_s.norm(), 0.0F);
}

// Beside the space, an object is suspected while it approaches and not while it leaves.
TEST(Objects, ApproachingIsSuspected) {
  for (const float step_m : {-0.05F, 0.05F}) {
    ObjectFinder finder(StructureParams(), 100, 100);
    EXPECT_FALSE(only_object(finder, chain_at({1, 1.5F, 0.5F})).suspected);
    EXPECT_EQ(only_object(finder, chain_at({1, 1.5F + step_m, 0.5F})).suspected, step_m < 0);
  }
  ObjectFinder finder(StructureParams(), 100, 100);  // too far to arrive within tau
  only_object(finder, chain_at({1, 9.0F, 0.5F}));
  EXPECT_FALSE(only_object(finder, chain_at({1, 8.95F, 0.5F})).suspected);
}

// Passing a corner of the space on the way out is no approach.
TEST(Objects, LeavingAcrossACornerIsNotSuspected) {
  ObjectFinder finder(StructureParams(), 100, 100);
  only_object(finder, chain_at({0.1F, 1.1F, 0.5F}));
  EXPECT_FALSE(only_object(finder, chain_at({0.07F, 1.09F, 0.5F})).suspected);
}

// After a merger, the whole follows the part that it shares most nodes with.
TEST(Objects, TheWholeFollowsItsLargerPart) {
  for (const int num_first : {2, 4}) {
    ObjectFinder finder(StructureParams(), 100, 100);
    const Topology whole = chain_at({1, 0, 0.5F}, 6);
    Topology parts = whole;
    parts.edges.erase(parts.edges.begin() + num_first - 1);
    finder.build(cloud_at(0.1F), parts);
    ASSERT_EQ(parts.objects.size(), 2U);
    const float larger_y_m = parts.objects[num_first == 2 ? 1 : 0].center_m.y();
    const Object object = only_object(finder, whole);
    EXPECT_NEAR(object.velocity_m_s.y(), -larger_y_m / 0.1F, 1e-4F);
  }
}

// After a split, each part follows the object that it shares most nodes with.
TEST(Objects, PartsFollowTheObjectOfTheirNodes) {
  ObjectFinder finder(StructureParams(), 100, 100);
  Topology whole = chain_at({1, 0, 0.5F}, 6);
  finder.build(cloud_at(0.1F), whole);
  Topology split = whole;
  split.edges.erase(split.edges.begin() + 2);  // nodes 0-2 and 3-5
  finder.build(cloud_at(0.1F), split);
  ASSERT_EQ(split.objects.size(), 2U);
  EXPECT_NEAR(split.objects[0].velocity_m_s.y(), -1.5F, 1e-4F);
  EXPECT_NEAR(split.objects[1].velocity_m_s.y(), 1.5F, 1e-4F);
}

}  // namespace
}  // namespace ddgng
