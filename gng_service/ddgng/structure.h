// SPDX-License-Identifier: BSD-3-Clause
// From a graph to surfaces, segments, planes and objects: the second half of the paper's Alg. 1, in
// its order. Reads the nodes and edges of a topology and fills the rest of it.
#pragma once

#include "ddgng/classification.h"
#include "ddgng/cloud.h"
#include "ddgng/objects.h"
#include "ddgng/planes.h"
#include "ddgng/segmentation.h"
#include "ddgng/structure_params.h"
#include "ddgng/topology.h"
#include "ddgng/triangulation.h"

namespace ddgng {

class StructureBuilder {
 public:
  StructureBuilder(const StructureParams& params, int max_nodes, int max_edges);

  /// Reads node_id, node_x_m, node_y_m, node_z_m and edges (ascending, a < b); writes node_class,
  /// node_object, node_plane, faces, labels, planes and objects. The first call with a topology
  /// reserves its capacities; later calls do not allocate. O(r d^3) for r nodes of degree d.
  void build(const CloudView& cloud, Topology& topology);

  /// Forgets the previous frame (object velocities start at 0 again).
  void reset();

  /// Faces and supplementary edges of the last call that exceeded a capacity; 0 in sound operation.
  int num_dropped() const { return triangulation_.num_dropped(); }

 private:
  void check_graph(const Topology& topology) const;
  void clear(Topology& topology) const;

  StructureParams params_;
  int max_nodes_;
  int max_edges_;
  Triangulation triangulation_;
  Segmentation segmentation_;
  PlaneFinder plane_finder_;
  ObjectFinder object_finder_;
};

}  // namespace ddgng
