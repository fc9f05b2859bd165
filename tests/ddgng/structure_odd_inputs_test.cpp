// SPDX-License-Identifier: BSD-3-Clause
// Graphs that a sound scene never gives: the structure stays bounded, finite and consistent.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "ddgng/structure.h"
#include "tests/ddgng/structure_scene.h"

namespace ddgng {
namespace {

using structure_scene::Cloud;
using structure_scene::make_topology;

using Nodes = std::vector<Eigen::Vector3f>;
using Edges = std::vector<std::pair<int, int>>;

StructureParams any_size_params() {
  StructureParams params;
  params.min_nodes = 1;
  return params;
}

void expect_sound(const Topology& topology) {
  const std::size_t num_nodes = topology.node_id.size();
  ASSERT_EQ(topology.node_class.size(), num_nodes);
  ASSERT_EQ(topology.node_object.size(), num_nodes);
  ASSERT_EQ(topology.node_plane.size(), num_nodes);
  for (const Face& face : topology.faces) {
    EXPECT_NEAR(face.normal.norm(), 1.0F, 1e-5F);
    EXPECT_GT(face.area_m2, 0.0F);
    EXPECT_TRUE(std::isfinite(face.area_m2));
    ASSERT_GE(face.label, 0);
    ASSERT_LT(face.label, static_cast<int>(topology.labels.size()));
  }
  for (const Label& label : topology.labels) {
    EXPECT_TRUE(label.normal.allFinite());
    EXPECT_FALSE(std::isnan(label.area_m2));
    EXPECT_GE(label.safety, 0.0F);
    EXPECT_LE(label.safety, 1.0F);
  }
  for (const Plane& plane : topology.planes) {
    EXPECT_TRUE(plane.normal.allFinite());
    EXPECT_TRUE(std::isfinite(plane.offset_m));
  }
  for (const Object& object : topology.objects) {
    EXPECT_FALSE(object.center_m.hasNaN());
    EXPECT_FALSE(object.size_m.hasNaN());
    EXPECT_FALSE(object.velocity_m_s.hasNaN());
  }
}

/// Two frames with the same graph; the second sees the objects of the first.
Topology build(const Nodes& nodes_m, const Edges& edges,
               const StructureParams& params = any_size_params()) {
  Topology topology = make_topology(nodes_m, edges);
  Cloud cloud;
  for (int i = 0; i < 1000; ++i) cloud.add(nodes_m.empty() ? Eigen::Vector3f(1, 0, 0) : nodes_m[0]);
  StructureBuilder builder(params, 200, 2000);
  builder.build(cloud.view(), topology);
  builder.build(cloud.view(), topology);
  expect_sound(topology);
  return topology;
}

Edges full_graph(int num_nodes) {
  Edges edges;
  for (int i = 0; i < num_nodes; ++i) {
    for (int j = i + 1; j < num_nodes; ++j) edges.emplace_back(i, j);
  }
  return edges;
}

// No node, no structure.
TEST(StructureOddInputs, NoNode) {
  const Topology topology = build({}, {});
  EXPECT_TRUE(topology.faces.empty());
  EXPECT_TRUE(topology.objects.empty());
}

// One or two nodes make no face.
TEST(StructureOddInputs, OneAndTwoNodes) {
  EXPECT_TRUE(build({{1, 0, 0}}, {}).faces.empty());
  const Topology two = build({{1, 0, 0}, {1, 0.1F, 0}}, {{0, 1}});
  EXPECT_TRUE(two.faces.empty());
  ASSERT_EQ(two.objects.size(), 1U);
  EXPECT_FLOAT_EQ(two.objects[0].size_m.y(), 0.1F);
}

// At or below theta_r nodes nothing is recognised, and what an earlier frame left is gone.
TEST(StructureOddInputs, TooFewNodesClearTheStructure) {
  Topology topology = make_topology({{1, 0, 0}, {1, 0.1F, 0}, {1, 0, 0.1F}}, full_graph(3));
  const Cloud cloud;
  StructureBuilder eager(any_size_params(), 10, 10);
  eager.build(cloud.view(), topology);
  ASSERT_EQ(topology.faces.size(), 1U);
  StructureBuilder builder(StructureParams(), 10, 10);
  builder.build(cloud.view(), topology);
  EXPECT_TRUE(topology.faces.empty());
  EXPECT_TRUE(topology.labels.empty());
  EXPECT_TRUE(topology.objects.empty());
  EXPECT_EQ(topology.node_class, std::vector<Class>(3, Class::kUnknown));
  EXPECT_EQ(topology.node_object, std::vector<int>(3, -1));
}

// Nodes without edges are obstacles of their own.
TEST(StructureOddInputs, NoEdges) {
  const Topology topology = build({{1, 0, 0}, {1, 0.1F, 0}, {1, 0, 0.1F}}, {});
  EXPECT_TRUE(topology.faces.empty());
  EXPECT_EQ(topology.objects.size(), 3U);
}

// Triangles of coincident or collinear nodes have no normal and are no faces.
TEST(StructureOddInputs, NoAreaNoFace) {
  EXPECT_TRUE(build({{1, 0, 0}, {1, 0, 0}, {1, 0.1F, 0}}, full_graph(3)).faces.empty());
  EXPECT_TRUE(build(Nodes(6, Eigen::Vector3f(1, 2, 3)), full_graph(6)).faces.empty());
  Nodes line_m;
  for (int i = 0; i < 8; ++i) line_m.emplace_back(1.0F, 0.125F * static_cast<float>(i), 0.5F);
  EXPECT_TRUE(build(line_m, full_graph(8)).faces.empty());
}

// Coordinates at the end of the number range give no NaN and no endless loop.
TEST(StructureOddInputs, HugeCoordinates) {
  for (const float huge : {1e9F, 1e19F, 3e38F}) {
    build({{huge, 0, 0}, {0, huge, 0}, {0, 0, huge}, {-huge, 0, 0}, {0, -huge, huge}},
          full_graph(5));
  }
}

// Five faces about one edge: each keeps its three nearest in angle, and all stay faces.
TEST(StructureOddInputs, FiveFacesAtOneEdge) {
  const Nodes nodes_m = {{1, 0, 0},          {1, 0, 1},           {2, 0, 0.5F},    {1.3F, 1, 0.5F},
                         {0.2F, 0.6F, 0.5F}, {0.2F, -0.6F, 0.5F}, {1.3F, -1, 0.5F}};
  Edges edges = {{0, 1}};
  for (int i = 2; i < 7; ++i) {
    edges.emplace_back(0, i);
    edges.emplace_back(1, i);
  }
  EXPECT_EQ(build(nodes_m, edges).faces.size(), 5U);
}

// In the full graph of six nodes all twenty triangles are faces and no cycle lacks a chord.
TEST(StructureOddInputs, FullGraphOfSixNodes) {
  const Nodes nodes_m = {{1, 0, 0}, {1, 1, 0}, {2, 0, 1}, {1, 2, 1.5F}, {2, 2, 0}, {3, 1, 2}};
  EXPECT_EQ(build(nodes_m, full_graph(6)).faces.size(), 20U);
}

// Faces beyond the capacity are left out and counted.
TEST(StructureOddInputs, FaceCapacityIsCounted) {
  StructureParams params = any_size_params();
  params.max_faces_per_node = 1;
  base::Rng rng(3);
  Nodes nodes_m;
  for (int i = 0; i < 12; ++i) {
    nodes_m.emplace_back(1.0 + rng.uniform(), rng.uniform(), rng.uniform());
  }
  Topology topology = make_topology(nodes_m, full_graph(12));
  StructureBuilder builder(params, 12, 66);
  builder.build(Cloud().view(), topology);
  expect_sound(topology);
  EXPECT_EQ(topology.faces.size(), 12U);
  EXPECT_EQ(builder.num_dropped(), 220 - 12);
}

// So are supplementary edges: two far poles and twenty nodes between give 190 short diagonals.
TEST(StructureOddInputs, SupplementaryEdgeCapacityIsCounted) {
  Nodes nodes_m = {{1, 0, 10}, {1, 0, -10}};
  Edges edges;
  base::Rng rng(5);
  for (int i = 2; i < 22; ++i) {
    nodes_m.emplace_back(1.0 + 0.1 * rng.uniform(), 0.1 * rng.uniform(), 0.1 * rng.uniform());
    edges.emplace_back(0, i);
    edges.emplace_back(1, i);
  }
  Topology topology = make_topology(nodes_m, edges);
  StructureBuilder builder(any_size_params(), 22, 40);
  builder.build(Cloud().view(), topology);
  expect_sound(topology);
  EXPECT_GT(builder.num_dropped(), 0);
  EXPECT_FALSE(topology.faces.empty());
}

// Without a valid head, or without points, the nodes keep the classes of their labels.
TEST(StructureOddInputs, NothingSeen) {
  structure_scene::LadderScene scene = structure_scene::make_ladder_scene(1);
  StructureBuilder builder(StructureParams(), 1000, 12000);
  builder.build(Cloud().view(), scene.topology);
  expect_sound(scene.topology);
  EXPECT_TRUE(scene.topology.planes.empty());
  EXPECT_EQ(scene.topology.node_class[0], Class::kSafeGround);
  CloudView blind = scene.cloud.view();
  blind.head_valid.fill(false);
  builder.build(blind, scene.topology);
  expect_sound(scene.topology);
  EXPECT_TRUE(scene.topology.planes.empty());
}

// Broken graphs are our own bug and are caught at the door.
TEST(StructureOddInputsDeathTest, BrokenGraphs) {
  StructureBuilder builder(StructureParams(), 2, 2);
  Topology topology = make_topology({{1, 0, 0}, {1, 0.1F, 0}, {1, 0, 0.1F}}, {});
  EXPECT_DEATH(builder.build(Cloud().view(), topology), "nodes within capacity");
  topology = make_topology({{1, 0, 0}, {1, 0.1F, 0}}, {});
  topology.edges = {{1, 0}};
  EXPECT_DEATH(builder.build(Cloud().view(), topology), "a < b");
  topology.edges = {{0, 1}, {0, 1}};
  EXPECT_DEATH(builder.build(Cloud().view(), topology), "edges ascend");
}

}  // namespace
}  // namespace ddgng
