// SPDX-License-Identifier: BSD-3-Clause
// After the first frame neither structure nor attention asks for memory.
#include <gtest/gtest.h>

#include "ddgng/attention.h"
#include "ddgng/structure.h"
#include "tests/ddgng/structure_scene.h"
#include "tests/support/allocation_counter.h"

namespace ddgng {
namespace {

using test_support::num_allocations;

/// Nodes, edges of one frame into a topology that keeps its memory.
void take_graph(const Topology& graph, Topology& topology) {
  topology.node_id = graph.node_id;
  topology.node_x_m = graph.node_x_m;
  topology.node_y_m = graph.node_y_m;
  topology.node_z_m = graph.node_z_m;
  topology.edges = graph.edges;
}

// A small first frame, then larger and other ones: not one allocation more, in each mode.
TEST(StructureAllocation, NoneAfterTheFirstFrame) {
  for (const StructureParams& params : {StructureParams(), paper_structure_params()}) {
    std::vector<structure_scene::LadderScene> scenes;
    for (int seed = 1; seed < 5; ++seed) scenes.push_back(structure_scene::make_ladder_scene(seed));
    base::Rng rng(1);
    std::vector<Topology> graphs;
    for (int i = 0; i < 4; ++i) graphs.push_back(structure_scene::random_surface(rng, 600));
    Topology topology;
    for (auto* values : {&topology.node_x_m, &topology.node_y_m, &topology.node_z_m}) {
      values->reserve(1000);
    }
    topology.node_id.reserve(1000);
    topology.edges.reserve(12000);
    StructureBuilder builder(params, 1000, 12000);
    Attention attention(params, 60000);
    take_graph(structure_scene::random_surface(rng, 20), topology);
    builder.build(scenes[0].cloud.view(), topology);

    const std::size_t before = num_allocations();
    for (int frame = 0; frame < 8; ++frame) {
      const CloudView cloud = scenes[frame % 4].cloud.view();
      take_graph(frame % 2 == 0 ? scenes[frame / 2].topology : graphs[frame / 2], topology);
      attention.set_regions(topology, cloud);
      attention.select(cloud);
      builder.build(cloud, topology);
    }
    EXPECT_EQ(num_allocations(), before);
    EXPECT_FALSE(topology.faces.empty());
  }
}

}  // namespace
}  // namespace ddgng
