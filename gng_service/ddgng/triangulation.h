// SPDX-License-Identifier: BSD-3-Clause
// Triangles between nodes (the surfaces B of the paper, section II-A). Pentagons and quadrilaterals
// are first closed by supplementary edges c', which are rebuilt each frame and never enter the GNG.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "ddgng/cloud.h"
#include "ddgng/neighborhood.h"
#include "ddgng/structure_params.h"
#include "ddgng/topology.h"

namespace ddgng {

class Triangulation {
 public:
  Triangulation(const StructureParams& params, int max_nodes, int max_edges);

  /// Fills topology.faces with normals (Eq. 1) and areas; labels stay -1. Triangles without area
  /// (coincident or collinear nodes) have no normal and are no faces.
  void build(const CloudView& cloud, Topology& topology);

  /// The sides of each face as indices below num_sides(): faces that share a side share an index.
  std::span<const std::array<int, 3>> face_sides() const { return face_sides_; }
  int num_sides() const { return static_cast<int>(sides_.size()); }
  /// Faces and supplementary edges of the last call that exceeded a capacity.
  int num_dropped() const { return num_dropped_; }
  int max_faces() const { return max_faces_; }
  int max_sides() const { return max_sides_; }

 private:
  void complete_pentagons(const Topology& topology);
  void complete_pentagon(const Topology& topology, const std::array<int, 5>& cycle);
  bool has_chord(const std::array<int, 5>& cycle) const;
  bool is_surrounded(const std::array<int, 5>& cycle) const;
  void complete_quadrilaterals(const Topology& topology);
  void join(int a, int b);
  void collect_sides(const Topology& topology);
  void find_faces(const CloudView& cloud, Topology& topology);
  void add_face(const CloudView& cloud, const std::array<int, 3>& sides, Topology& topology);

  bool complete_;
  int max_faces_;
  int max_sides_;
  Neighborhood joined_;               ///< c and c'
  std::vector<int> near_a_, near_b_;  ///< the last node a (b) of a cycle that has an edge to here
  std::vector<Edge> added_sides_;     ///< c', ascending (a, b)
  std::vector<Edge> sides_;           ///< c and c' together, ascending (a, b)
  std::vector<int> first_side_;       ///< of node a: the index of its first side in sides_
  std::vector<int> side_to_;          ///< side from the current node to this node, -1 = none
  std::vector<std::array<int, 3>> face_sides_;
  int num_dropped_ = 0;
};

}  // namespace ddgng
