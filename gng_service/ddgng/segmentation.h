// SPDX-License-Identifier: BSD-3-Clause
// Faces joined into labels (paper, section II-A, steps 1 to 5). The steps merge labels in any
// order, so their result is the set of connected components, found here by union-find.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "ddgng/disjoint_sets.h"
#include "ddgng/structure_params.h"
#include "ddgng/topology.h"

namespace ddgng {

class Segmentation {
 public:
  Segmentation(const StructureParams& params, int max_faces, int max_sides);

  /// Sets the label of each face and fills topology.labels (normal by Eq. 3, area, num_faces), in
  /// ascending order of their first face. face_sides: see Triangulation.
  void build(std::span<const std::array<int, 3>> face_sides, int num_sides, Topology& topology);

 private:
  void group_by_side(std::span<const std::array<int, 3>> face_sides, int num_sides);
  void join_neighbors(int face_index, const std::array<int, 3>& sides, const Topology& topology);
  void make_labels(Topology& topology);

  float cosine_threshold_;
  DisjointSets sets_;
  std::vector<int> first_at_side_;  ///< of side s: the first place in faces_at_side_; one past all
  std::vector<int> faces_at_side_;
  std::vector<int> label_of_root_;
};

}  // namespace ddgng
