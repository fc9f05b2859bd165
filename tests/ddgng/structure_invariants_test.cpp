// SPDX-License-Identifier: BSD-3-Clause
// What holds for every structure: faces, labels and sums fit together, and neither the place of the
// scene nor the order of its nodes matters.
#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <set>

#include <gtest/gtest.h>

#include "ddgng/structure.h"
#include "tests/ddgng/structure_scene.h"

namespace ddgng {
namespace {

using structure_scene::make_topology;

Topology built(Topology topology, const CloudView& cloud, bool complete) {
  StructureParams params = paper_structure_params();
  params.complete_quadrilaterals_and_pentagons = complete;
  StructureBuilder builder(params, 500, 8000);
  builder.build(cloud, topology);
  return topology;
}

std::vector<int> face_labels(const Topology& topology) {
  std::vector<int> labels;
  for (const Face& face : topology.faces) labels.push_back(face.label);
  return labels;
}

/// The partition as a set of sets of faces, each node renamed.
std::set<std::set<std::array<int, 3>>> partition(const Topology& topology,
                                                 const std::vector<int>& name) {
  std::map<int, std::set<std::array<int, 3>>> of_label;
  for (const Face& face : topology.faces) {
    std::array<int, 3> nodes = {name[face.nodes[0]], name[face.nodes[1]], name[face.nodes[2]]};
    std::sort(nodes.begin(), nodes.end());
    of_label[face.label].insert(nodes);
  }
  std::set<std::set<std::array<int, 3>>> result;
  for (const auto& [label, faces] : of_label) result.insert(faces);
  return result;
}

// Faces ascend and, without completion, each pair of their nodes is joined by an edge; labels count
// all faces once and hold the sums of Eq. (3).
TEST(StructureInvariants, FacesAndLabelsFitTogether) {
  for (int seed = 0; seed < 40; ++seed) {
    base::Rng rng(seed);
    const Topology topology =
        built(structure_scene::random_surface(rng, 80), structure_scene::Cloud().view(), false);
    ASSERT_FALSE(topology.faces.empty());
    std::set<std::pair<int, int>> joined;
    for (const Edge& edge : topology.edges) joined.emplace(edge.a, edge.b);
    std::vector<Label> sums(topology.labels.size());
    for (Label& sum : sums) sum.normal.setZero();
    for (std::size_t i = 0; i < topology.faces.size(); ++i) {
      const auto [a, b, c] = topology.faces[i].nodes;
      EXPECT_TRUE(joined.count({a, b}) > 0 && joined.count({a, c}) > 0 && joined.count({b, c}) > 0);
      if (i > 0) {
        EXPECT_LT(topology.faces[i - 1].nodes, topology.faces[i].nodes);
      }
      Label& sum = sums[topology.faces[i].label];
      sum.normal += topology.faces[i].normal;
      sum.area_m2 += topology.faces[i].area_m2;
      ++sum.num_faces;
    }
    for (std::size_t i = 0; i < sums.size(); ++i) {
      EXPECT_EQ(topology.labels[i].num_faces, sums[i].num_faces);
      EXPECT_FLOAT_EQ(topology.labels[i].area_m2, sums[i].area_m2);
      const Eigen::Vector3f mean = sums[i].normal / static_cast<float>(sums[i].num_faces);
      EXPECT_LT((topology.labels[i].normal - mean).norm(), 1e-6F);
    }
  }
}

// Completion only adds faces.
TEST(StructureInvariants, CompletionKeepsTheFacesThereAre) {
  int num_added = 0;
  for (int seed = 0; seed < 20; ++seed) {
    base::Rng rng(seed);
    const Topology graph = structure_scene::random_surface(rng, 80);
    const structure_scene::Cloud cloud;
    const Topology plain = built(graph, cloud.view(), false);
    const Topology completed = built(graph, cloud.view(), true);
    std::set<std::array<int, 3>> faces;
    for (const Face& face : completed.faces) faces.insert(face.nodes);
    for (const Face& face : plain.faces) EXPECT_TRUE(faces.count(face.nodes) > 0);
    num_added += static_cast<int>(completed.faces.size() - plain.faces.size());
  }
  EXPECT_GT(num_added, 0);
}

// A turn about the vertical and a shift, of nodes and heads together, change no label.
TEST(StructureInvariants, RigidMotionLeavesTheLabels) {
  Eigen::Matrix3f turn;
  turn << 0.6F, -0.8F, 0.0F, 0.8F, 0.6F, 0.0F, 0.0F, 0.0F, 1.0F;
  const Eigen::Vector3f shift_m(0.5F, -0.25F, 0.125F);
  for (int seed = 0; seed < 20; ++seed) {
    base::Rng rng(seed);
    const Topology graph = structure_scene::random_surface(rng, 80);
    Topology moved = graph;
    for (int i = 0; i < moved.num_nodes(); ++i) {
      const Eigen::Vector3f p = turn * graph.node_m(i) + shift_m;
      moved.node_x_m[i] = p.x();
      moved.node_y_m[i] = p.y();
      moved.node_z_m[i] = p.z();
    }
    const structure_scene::Cloud cloud;
    CloudView moved_cloud = cloud.view();
    for (auto& head_m : moved_cloud.head_position_m) head_m = turn * head_m + shift_m;
    const Topology here = built(graph, cloud.view(), true);
    const Topology there = built(moved, moved_cloud, true);
    EXPECT_EQ(face_labels(here), face_labels(there)) << "seed " << seed;
    ASSERT_EQ(here.labels.size(), there.labels.size());
    for (std::size_t i = 0; i < here.labels.size(); ++i) {
      EXPECT_EQ(here.labels[i].label_class, there.labels[i].label_class);
    }
  }
}

// Numbering the nodes otherwise gives the same faces in the same labels.
TEST(StructureInvariants, TheOrderOfNodesDoesNotMatter) {
  for (int seed = 0; seed < 20; ++seed) {
    base::Rng rng(seed);
    const Topology graph = structure_scene::random_surface(rng, 80);
    std::vector<int> new_name(graph.num_nodes());
    std::iota(new_name.begin(), new_name.end(), 0);
    for (int i = graph.num_nodes() - 1; i > 0; --i)
      std::swap(new_name[i], new_name[rng.below(i + 1)]);
    std::vector<Eigen::Vector3f> nodes_m(graph.num_nodes());
    std::vector<int> old_name(graph.num_nodes());
    for (int i = 0; i < graph.num_nodes(); ++i) {
      nodes_m[new_name[i]] = graph.node_m(i);
      old_name[new_name[i]] = i;
    }
    std::vector<std::pair<int, int>> edges;
    for (const Edge& edge : graph.edges) edges.emplace_back(new_name[edge.a], new_name[edge.b]);

    const structure_scene::Cloud cloud;
    const Topology before = built(graph, cloud.view(), false);
    const Topology after = built(make_topology(nodes_m, edges), cloud.view(), false);
    std::vector<int> same(graph.num_nodes());
    std::iota(same.begin(), same.end(), 0);
    EXPECT_EQ(partition(before, same), partition(after, old_name)) << "seed " << seed;
  }
}

}  // namespace
}  // namespace ddgng
