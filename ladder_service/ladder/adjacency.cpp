// SPDX-License-Identifier: BSD-3-Clause
#include "ladder/adjacency.h"

#include <algorithm>

namespace ladder {

Adjacency::Adjacency(int max_nodes, int max_edges) : max_nodes_(max_nodes), max_edges_(max_edges) {
  begin_.reserve(static_cast<std::size_t>(max_nodes) + 2);
  neighbor_.reserve(2 * static_cast<std::size_t>(max_edges));
}

void Adjacency::build(const NodeCloud& cloud) {
  const int num_nodes = std::min(cloud.num_nodes(), max_nodes_);
  const auto num_edges = std::min<std::size_t>(cloud.edges.size(), max_edges_);
  const std::span<const Edge> edges(cloud.edges.data(), num_edges);
  // Count, sum up, then fill from the back: begin_[i] ends at the first neighbour of node i.
  begin_.assign(num_nodes + 1, 0);
  neighbor_.resize(2 * num_edges);
  for (const Edge& e : edges) {
    if (e.a >= num_nodes || e.b >= num_nodes) continue;
    ++begin_[e.a];
    ++begin_[e.b];
  }
  for (int i = 1; i <= num_nodes; ++i) begin_[i] += begin_[i - 1];
  for (const Edge& e : edges) {
    if (e.a >= num_nodes || e.b >= num_nodes) continue;
    neighbor_[--begin_[e.a]] = e.b;
    neighbor_[--begin_[e.b]] = e.a;
  }
}

std::span<const int> Adjacency::neighbors(int node) const {
  if (node + 1 >= static_cast<int>(begin_.size())) return {};
  const int first = begin_[node];
  return {neighbor_.data() + first, static_cast<std::size_t>(begin_[node + 1] - first)};
}

}  // namespace ladder
