// SPDX-License-Identifier: BSD-3-Clause
#include "ddgng/neighborhood.h"

#include <algorithm>

namespace ddgng {

Neighborhood::Neighborhood(int max_nodes, int max_edges)
    : max_supplementary_(static_cast<std::size_t>(max_edges)) {
  first_.reserve(max_nodes + 1);
  neighbors_.reserve(2 * max_edges);
  last_arc_.reserve(max_nodes);
  arcs_.reserve(2 * max_edges);
  supplementary_.reserve(max_edges);
}

void Neighborhood::reset(int num_nodes, std::span<const Edge> edges) {
  num_nodes_ = num_nodes;
  last_arc_.assign(num_nodes, -1);
  arcs_.clear();
  supplementary_.clear();

  first_.assign(num_nodes + 1, 0);
  for (const Edge& edge : edges) {
    ++first_[edge.a];
    ++first_[edge.b];
  }
  int end = 0;
  for (int& place : first_) place = (end += place);
  // Filled from the back in descending edge order: rows come out ascending, first_ ends at the row
  // starts.
  neighbors_.resize(2 * edges.size());
  for (auto edge = edges.rbegin(); edge != edges.rend(); ++edge) {
    neighbors_[--first_[edge->a]] = edge->b;
    neighbors_[--first_[edge->b]] = edge->a;
  }
}

bool Neighborhood::join(int a, int b) {
  if (supplementary_.size() == max_supplementary_) return false;
  supplementary_.push_back({std::min(a, b), std::max(a, b)});
  arcs_.push_back({b, last_arc_[a]});
  last_arc_[a] = static_cast<int>(arcs_.size()) - 1;
  arcs_.push_back({a, last_arc_[b]});
  last_arc_[b] = static_cast<int>(arcs_.size()) - 1;
  return true;
}

bool Neighborhood::is_edge(int a, int b) const {
  for (const int other : neighbors(a)) {
    if (other == b) return true;
  }
  return false;
}

bool Neighborhood::is_joined(int a, int b) const {
  if (is_edge(a, b)) return true;
  for (int arc = last_arc_[a]; arc >= 0; arc = arcs_[arc].previous) {
    if (arcs_[arc].to == b) return true;
  }
  return false;
}

}  // namespace ddgng
