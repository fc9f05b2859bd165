// SPDX-License-Identifier: BSD-3-Clause
// Copies the growing graph into the outgoing Topology: nodes ascending by id, edges and moments
// ascending by node index. Nothing of the structure above them.
#pragma once

#include <vector>

#include "ddgng/growing.h"
#include "ddgng/moments.h"
#include "ddgng/topology.h"

namespace ddgng {

class Snapshot {
 public:
  explicit Snapshot(const Graph& graph);

  /// Makes room for the largest graph, so that take() never allocates.
  void reserve(Topology& topology) const;
  /// Overwrites nodes, moments and edges of the topology.
  void take(const Growing& growing, const Moments& moments, Topology& topology);

 private:
  int max_nodes_;
  int max_edges_;
  std::vector<int> slot_of_node_;  // ascending by id
  std::vector<int> node_of_slot_;
};

}  // namespace ddgng
