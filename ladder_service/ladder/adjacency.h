// SPDX-License-Identifier: BSD-3-Clause
// The graph's edges as a list of neighbours per node.
#pragma once

#include <span>
#include <vector>

#include "ladder/node_cloud.h"

namespace ladder {

class Adjacency {
 public:
  Adjacency(int max_nodes, int max_edges);

  /// Edges above the capacity are left out, nodes above it have no neighbours.
  void build(const NodeCloud& cloud);
  std::span<const int> neighbors(int node) const;

 private:
  int max_nodes_;
  int max_edges_;
  std::vector<int> begin_;  ///< per node, one more than nodes
  std::vector<int> neighbor_;
};

}  // namespace ladder
