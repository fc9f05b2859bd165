// SPDX-License-Identifier: BSD-3-Clause
// Who is joined to whom: the edges c of the GNG and the supplementary edges c' of one frame.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "ddgng/topology.h"

namespace ddgng {

class Neighborhood {
 public:
  Neighborhood(int max_nodes, int max_edges);

  /// The edges c, ascending (a, b) with a < b; no supplementary edges.
  void reset(int num_nodes, std::span<const Edge> edges);

  /// Adds c'_ab; false when the capacity (max_edges) is used up.
  bool join(int a, int b);

  int num_nodes() const { return num_nodes_; }

  /// Nodes joined to this one by c, ascending.
  std::span<const int> neighbors(int node) const {
    return {neighbors_.data() + first_[node], neighbors_.data() + first_[node + 1]};
  }

  /// True when c_ab = 1. O(degree).
  bool is_edge(int a, int b) const;

  /// True when c_ab = 1 or c'_ab = 1. O(degree).
  bool is_joined(int a, int b) const;

  /// Calls visit(other) for each node joined to this one by c or c'.
  template <typename Visit>
  void for_each_joined(int node, Visit visit) const {
    for (const int other : neighbors(node)) visit(other);
    for (int arc = last_arc_[node]; arc >= 0; arc = arcs_[arc].previous) visit(arcs_[arc].to);
  }

  /// The edges c' in the order of joining, a < b.
  std::span<const Edge> supplementary() const { return supplementary_; }

 private:
  struct Arc {
    int to;
    int previous;  ///< arc of the same node, -1 = none
  };

  std::size_t max_supplementary_;
  int num_nodes_ = 0;
  std::vector<int> first_, neighbors_;  ///< c as one row per node
  std::vector<int> last_arc_;           ///< c' as one chain per node
  std::vector<Arc> arcs_;
  std::vector<Edge> supplementary_;
};

}  // namespace ddgng
