// SPDX-License-Identifier: BSD-3-Clause
// Surfaces, segments and classes exactly as the text of the paper counts them: loops over tuples of
// nodes, label merging in its five steps, angles by acos. Slow; the oracle of the library's tests.
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "ddgng/cloud.h"
#include "ddgng/structure_params.h"
#include "ddgng/topology.h"

namespace reference {

struct Structure {
  std::vector<std::array<int, 3>> faces;           ///< ascending
  std::vector<Eigen::Vector3d> normals;            ///< Eq. (1), parallel to faces
  std::vector<int> face_label;                     ///< as the five steps leave it, 1.. with holes
  std::vector<ddgng::Class> face_class;            ///< of the face's label, Eq. (5)
  std::vector<Eigen::Vector3d> face_label_normal;  ///< Eq. (3) of the face's label
};

/// Reads node positions and edges.
Structure build_structure(const ddgng::StructureParams& params, const ddgng::CloudView& cloud,
                          const ddgng::Topology& graph);

}  // namespace reference
