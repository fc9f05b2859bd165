// SPDX-License-Identifier: BSD-3-Clause
#include "ddgng/structure.h"

#include <tuple>

#include "base/check.h"

namespace ddgng {

StructureBuilder::StructureBuilder(const StructureParams& params, int max_nodes, int max_edges)
    : params_(params),
      max_nodes_(max_nodes),
      max_edges_(max_edges),
      triangulation_(params, max_nodes, max_edges),
      segmentation_(params, triangulation_.max_faces(), triangulation_.max_sides()),
      plane_finder_(params, max_nodes, triangulation_.max_faces()),
      object_finder_(params, max_nodes, triangulation_.max_faces()) {
  CHECK(check(params).empty(), "structure parameters are in range");
}

void StructureBuilder::build(const CloudView& cloud, Topology& topology) {
  check_graph(topology);
  clear(topology);
  if (topology.num_nodes() <= params_.min_nodes) return;  // r > theta_r

  triangulation_.build(cloud, topology);
  segmentation_.build(triangulation_.face_sides(), triangulation_.num_sides(), topology);
  classify_labels(params_, topology);
  classify_nodes_by_labels(topology);
  if (params_.refit_planes) plane_finder_.build(cloud, topology);
  object_finder_.build(cloud, topology);
}

void StructureBuilder::reset() {
  object_finder_.reset();
}

void StructureBuilder::check_graph(const Topology& topology) const {
  const int num_nodes = topology.num_nodes();
  CHECK(num_nodes <= max_nodes_, "nodes within capacity");
  CHECK(static_cast<int>(topology.edges.size()) <= max_edges_, "edges within capacity");
  Edge before{-1, -1};
  for (const Edge& edge : topology.edges) {
    CHECK(0 <= edge.a && edge.a < edge.b && edge.b < num_nodes, "edges join two nodes, a < b");
    CHECK(std::tie(before.a, before.b) < std::tie(edge.a, edge.b), "edges ascend");
    before = edge;
  }
}

void StructureBuilder::clear(Topology& topology) const {
  topology.faces.clear();
  topology.labels.clear();
  topology.planes.clear();
  topology.objects.clear();
  topology.faces.reserve(triangulation_.max_faces());
  topology.labels.reserve(triangulation_.max_faces());
  topology.planes.reserve(params_.max_planes);
  topology.objects.reserve(max_nodes_);
  topology.node_class.reserve(max_nodes_);
  topology.node_object.reserve(max_nodes_);
  topology.node_plane.reserve(max_nodes_);
  topology.node_class.assign(topology.num_nodes(), Class::kUnknown);
  topology.node_object.assign(topology.num_nodes(), -1);
  topology.node_plane.assign(topology.num_nodes(), -1);
}

}  // namespace ddgng
