// SPDX-License-Identifier: BSD-3-Clause
// The two nodes nearest to a signal (first and second winner), exactly: the distance of every node
// counts as (dx dx + dy dy) + dz dz rounded in float, ties go to the lowest slot, and every
// instruction set gives the same answer.
#pragma once

#include <Eigen/Core>

#include "ddgng/graph.h"

namespace ddgng {

struct Winners {
  int first = -1;   ///< s1, slot
  int second = -1;  ///< s2, slot
  float first_m2 = 0.0F;
  float second_m2 = 0.0F;
};

/// Looks at every slot. Needs at least two nodes. O(slots).
Winners nearest_two_linear(const Graph& graph, const Eigen::Vector3f& signal_m);

}  // namespace ddgng
