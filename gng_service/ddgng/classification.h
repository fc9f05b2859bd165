// SPDX-License-Identifier: BSD-3-Clause
// Safe ground, wall or obstacle by slope and size (Eq. 4, 5), and the safety degree. Angles are
// compared as cosines.
#pragma once

#include <Eigen/Core>

#include "ddgng/structure_params.h"
#include "ddgng/topology.h"

namespace ddgng {

/// Large enough for ground, a wall or a plane.
bool is_large(const StructureParams& params, const Label& label);

/// Eq. (5) of a normal alone; it need not have unit length. A zero normal has no slope: obstacle.
Class classify_slope(const StructureParams& params, const Eigen::Vector3f& normal);

/// 1 - theta_n / 90 deg, theta_n by Eq. (4); 0 when vertical, overhanging or zero.
float safety_degree(const Eigen::Vector3f& normal);

/// Sets label_class and safety of each label.
void classify_labels(const StructureParams& params, Topology& topology);

/// Sets node_class: safe ground where a node is part of such a label, else wall, else obstacle. A
/// node in no face is an obstacle.
void classify_nodes_by_labels(Topology& topology);

/// The angle of a cosine 0..1 [rad], |error| < 1e-6, never increasing; the same bits everywhere.
float arc_cosine(float cosine);

}  // namespace ddgng
