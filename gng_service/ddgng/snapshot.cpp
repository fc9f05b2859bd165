// SPDX-License-Identifier: BSD-3-Clause
#include "ddgng/snapshot.h"

#include <algorithm>

namespace ddgng {

Snapshot::Snapshot(const Graph& graph)
    : max_nodes_(graph.max_nodes()),
      max_edges_(graph.max_edges()),
      node_of_slot_(graph.padded_slots()) {
  slot_of_node_.reserve(max_nodes_);
}

void Snapshot::reserve(Topology& topology) const {
  topology.node_id.reserve(max_nodes_);
  for (auto* values :
       {&topology.node_x_m, &topology.node_y_m, &topology.node_z_m, &topology.node_strength,
        &topology.node_error_m2, &topology.node_utility_m2}) {
    values->reserve(max_nodes_);
  }
  topology.moments.reserve(static_cast<std::size_t>(max_nodes_) * kNumHeads);
  topology.edges.reserve(max_edges_);
}

void Snapshot::take(const Growing& growing, const Moments& moments, Topology& topology) {
  const Graph& graph = growing.graph();
  slot_of_node_.clear();
  for (int slot = 0; slot < graph.num_slots(); ++slot) {
    if (graph.alive(slot)) slot_of_node_.push_back(slot);
  }
  std::sort(slot_of_node_.begin(), slot_of_node_.end(),
            [&](int a, int b) { return graph.id(a) < graph.id(b); });

  topology.node_id.clear();
  for (auto* values :
       {&topology.node_x_m, &topology.node_y_m, &topology.node_z_m, &topology.node_strength,
        &topology.node_error_m2, &topology.node_utility_m2}) {
    values->clear();
  }
  topology.moments.clear();
  topology.edges.clear();
  const int num_nodes = graph.num_nodes();
  for (int node = 0; node < num_nodes; ++node) {
    const int slot = slot_of_node_[node];
    node_of_slot_[slot] = node;
    topology.node_id.push_back(graph.id(slot));
    const Eigen::Vector3f position_m = graph.position_m(slot);
    topology.node_x_m.push_back(position_m.x());
    topology.node_y_m.push_back(position_m.y());
    topology.node_z_m.push_back(position_m.z());
    topology.node_strength.push_back(growing.strength(slot));
    topology.node_error_m2.push_back(growing.error_m2(slot));
    topology.node_utility_m2.push_back(growing.utility_m2(slot));
    moments.append(slot, node, topology.moments);
  }
  for (int a = 0; a < num_nodes; ++a) {
    const std::size_t first = topology.edges.size();
    for (const int neighbour : graph.neighbours(slot_of_node_[a])) {
      const int b = node_of_slot_[neighbour];
      if (a < b) topology.edges.push_back({a, b});
    }
    std::sort(topology.edges.begin() + static_cast<std::ptrdiff_t>(first), topology.edges.end(),
              [](const Edge& left, const Edge& right) { return left.b < right.b; });
  }
}

}  // namespace ddgng
