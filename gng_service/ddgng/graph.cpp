// SPDX-License-Identifier: BSD-3-Clause
#include "ddgng/graph.h"

#include <algorithm>
#include <limits>

#include "base/check.h"

namespace ddgng {

Graph::Graph(int max_nodes, int max_degree) : max_nodes_(max_nodes), max_degree_(max_degree) {
  CHECK(max_nodes >= 2 && max_nodes <= kNodeLimit, "max_nodes out of range");
  CHECK(max_degree >= 2 && max_degree <= kDegreeLimit, "max_degree out of range");
  const int padded = (max_nodes + kSlotBlock - 1) / kSlotBlock * kSlotBlock;
  positions_.resize(padded);
  id_.resize(padded);
  wins_.resize(padded);
  links_.resize(padded);
  order_.reserve(padded);
  clear();
}

void Graph::clear() {
  std::fill(positions_.begin(), positions_.end(), Position{});
  std::fill(id_.begin(), id_.end(), -1);
  std::fill(wins_.begin(), wins_.end(), std::uint16_t{0});
  std::fill(links_.begin(), links_.end(), Links{});
  num_nodes_ = num_slots_ = lowest_free_ = next_id_ = 0;
}

void Graph::renumber() {
  order_.clear();
  for (int slot = 0; slot < num_slots_; ++slot) {
    if (alive(slot)) order_.push_back(slot);
  }
  std::sort(order_.begin(), order_.end(), [this](int a, int b) { return id_[a] < id_[b]; });
  next_id_ = 0;
  for (const int slot : order_) id_[slot] = next_id_++;
}

void Graph::move_towards(int slot, const Eigen::Vector3f& target_m, float rate) {
  Position& p = positions_[slot];
  p.x_m += rate * (target_m.x() - p.x_m);
  p.y_m += rate * (target_m.y() - p.y_m);
  p.z_m += rate * (target_m.z() - p.z_m);
}

int Graph::add_node(const Eigen::Vector3f& position_m) {
  CHECK(num_nodes_ < max_nodes_, "add_node on a full graph");
  if (next_id_ == std::numeric_limits<int>::max()) renumber();
  const int slot = lowest_free_;
  positions_[slot] = {position_m.x(), position_m.y(), position_m.z(), 0.0F};
  id_[slot] = next_id_++;
  ++num_nodes_;
  num_slots_ = std::max(num_slots_, slot + 1);
  while (lowest_free_ < num_slots_ && alive(lowest_free_)) ++lowest_free_;
  return slot;
}

void Graph::remove_node(int slot) {
  CHECK(alive(slot), "remove_node on an empty slot");
  while (degree(slot) > 0) separate(slot, links_[slot].neighbour[0]);
  positions_[slot] = {};
  id_[slot] = -1;
  --num_nodes_;
  lowest_free_ = std::min(lowest_free_, slot);
  while (num_slots_ > 0 && !alive(num_slots_ - 1)) --num_slots_;
}

int Graph::find(int a, int b) const {
  const Links& links = links_[a];
  for (int k = 0; k < links.degree; ++k) {
    if (links.neighbour[k] == b) return k;
  }
  return -1;
}

void Graph::drop_half(int a, int k) {
  Links& links = links_[a];
  --links.degree;
  links.neighbour[k] = links.neighbour[links.degree];
  links.born[k] = links.born[links.degree];
  links.neighbour[links.degree] = kNobody;
}

void Graph::add_half(int a, int b) {
  Links& links = links_[a];
  links.neighbour[links.degree] = static_cast<std::uint16_t>(b);
  links.born[links.degree] = static_cast<std::uint16_t>(wins_[a] + wins_[b]);
  ++links.degree;
}

void Graph::drop_oldest(int slot) {
  int oldest = 0;
  for (int k = 1; k < degree(slot); ++k) {
    const int older_by = age(slot, k) - age(slot, oldest);
    const bool lower = links_[slot].neighbour[k] < links_[slot].neighbour[oldest];
    if (older_by > 0 || (older_by == 0 && lower)) oldest = k;
  }
  separate(slot, links_[slot].neighbour[oldest]);
}

int Graph::join(int a, int b) {
  CHECK(a != b, "a node cannot be joined with itself");
  const int k = find(a, b);
  if (k >= 0) {
    const auto now = static_cast<std::uint16_t>(wins_[a] + wins_[b]);
    links_[a].born[k] = now;
    links_[b].born[find(b, a)] = now;
    return 0;
  }
  int num_dropped = 0;
  for (const int end : {a, b}) {
    if (degree(end) < max_degree_) continue;
    drop_oldest(end);
    ++num_dropped;
  }
  add_half(a, b);
  add_half(b, a);
  return num_dropped;
}

void Graph::separate(int a, int b) {
  const int k = find(a, b);
  CHECK(k >= 0, "separate needs an edge");
  drop_half(a, k);
  drop_half(b, find(b, a));
}

}  // namespace ddgng
