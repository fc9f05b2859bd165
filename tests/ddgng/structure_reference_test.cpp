// SPDX-License-Identifier: BSD-3-Clause
// The library against the paper-literal version: faces, partition into labels and classes are
// equal.
#include "tests/reference/structure_reference.h"

#include <map>

#include <gtest/gtest.h>

#include "ddgng/structure.h"
#include "tests/ddgng/structure_scene.h"

namespace ddgng {
namespace {

/// Labels as numbers in the order of their first face.
std::vector<int> in_order_of_appearance(const std::vector<int>& labels) {
  std::map<int, int> number;
  std::vector<int> result;
  for (const int label : labels) {
    result.push_back(number.emplace(label, static_cast<int>(number.size())).first->second);
  }
  return result;
}

struct Totals {
  int num_faces = 0, num_labels = 0, num_plane_faces = 0;
};

Totals expect_equal_to_reference(const Topology& graph, const StructureParams& params) {
  Topology topology = graph;
  const structure_scene::Cloud cloud;
  const CloudView view = cloud.view();
  StructureBuilder builder(params, topology.num_nodes(), 4 * static_cast<int>(graph.edges.size()));
  builder.build(view, topology);
  const reference::Structure expected = reference::build_structure(params, view, graph);

  std::vector<std::array<int, 3>> faces;
  std::vector<int> face_label;
  for (const Face& face : topology.faces) {
    faces.push_back(face.nodes);
    face_label.push_back(face.label);
  }
  EXPECT_EQ(builder.num_dropped(), 0);
  EXPECT_EQ(faces, expected.faces);
  EXPECT_EQ(face_label, in_order_of_appearance(expected.face_label));
  if (testing::Test::HasFailure()) return {};
  Totals totals{static_cast<int>(faces.size()), static_cast<int>(topology.labels.size()), 0};
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const Label& label = topology.labels[face_label[i]];
    EXPECT_LT((topology.faces[i].normal.cast<double>() - expected.normals[i]).norm(), 1e-5);
    EXPECT_EQ(label.label_class, expected.face_class[i]);
    EXPECT_LT((label.normal.cast<double>() - expected.face_label_normal[i]).norm(), 1e-5);
    if (label.label_class != Class::kObstacle) ++totals.num_plane_faces;
  }
  return totals;
}

StructureParams test_params(bool complete) {
  StructureParams params = paper_structure_params();
  params.min_nodes = 1;
  params.complete_quadrilaterals_and_pentagons = complete;
  return params;
}

class StructureReferenceTest : public testing::TestWithParam<bool> {};

// On surfaces with holes, where labels grow large.
TEST_P(StructureReferenceTest, EqualOnSurfaces) {
  int num_plane_faces = 0;
  for (int seed = 0; seed < 60; ++seed) {
    base::Rng rng(seed);
    const Topology graph = structure_scene::random_surface(rng, 10 + 4 * (seed % 10));
    const Totals totals = expect_equal_to_reference(graph, test_params(GetParam()));
    ASSERT_FALSE(HasFailure()) << "seed " << seed;
    num_plane_faces += totals.num_plane_faces;
  }
  EXPECT_GT(num_plane_faces, 50);  // or classes were not compared
}

// On tangles, where many faces meet at an edge and merge in any order.
TEST_P(StructureReferenceTest, EqualOnTangles) {
  StructureParams params = test_params(GetParam());
  params.segment_angle_deg = 40.0F;
  int num_faces = 0;
  int num_labels = 0;
  for (int seed = 0; seed < 60; ++seed) {
    base::Rng rng(1000 + seed);
    const Topology graph = structure_scene::random_tangle(rng, 5 + seed % 14);
    const Totals totals = expect_equal_to_reference(graph, params);
    ASSERT_FALSE(HasFailure()) << "seed " << seed;
    num_faces += totals.num_faces;
    num_labels += totals.num_labels;
  }
  EXPECT_GT(num_labels, 60);
  EXPECT_LT(num_labels, num_faces / 2);  // or nothing was merged
}

INSTANTIATE_TEST_SUITE_P(Completion, StructureReferenceTest, testing::Bool());

}  // namespace
}  // namespace ddgng
