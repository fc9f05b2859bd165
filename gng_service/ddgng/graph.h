// SPDX-License-Identifier: BSD-3-Clause
// The GNG's nodes and edges: positions, adjacency of bounded degree, edge ages. A node lives in a
// slot (reused, lowest free first) and carries an id (never reused). Knows nothing of errors,
// strengths or signals. No allocation after construction.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace ddgng {

class Graph {
 public:
  static constexpr int kNodeLimit = 32767;
  static constexpr int kDegreeLimit = 31;
  static constexpr int kAgeLimit = 30000;
  static constexpr int kSlotBlock = 16;  ///< arrays over slots are padded to a multiple of this
  static constexpr float kFar_m = 1e9F;  ///< coordinates of an empty slot: no signal is near it

  /// 2 <= max_nodes <= kNodeLimit, 2 <= max_degree <= kDegreeLimit.
  Graph(int max_nodes, int max_degree);

  void clear();

  int num_nodes() const { return num_nodes_; }
  int max_nodes() const { return max_nodes_; }
  int max_edges() const { return max_nodes_ * max_degree_ / 2; }
  /// Every living slot is below this.
  int num_slots() const { return num_slots_; }
  /// Length of arrays over slots.
  int padded_slots() const { return static_cast<int>(positions_.size()); }

  bool alive(int slot) const { return id_[slot] >= 0; }
  /// Unique among all nodes since clear() or renumber(), ascending with creation; -1 = empty slot.
  /// After 2^31 nodes (days at full speed) add_node() renumbers.
  int id(int slot) const { return id_[slot]; }
  int next_id() const { return next_id_; }
  /// Gives the living nodes the ids 0, 1, ... in their present order.
  void renumber();

  /// To be read as one vector of four.
  struct alignas(16) Position {
    float x_m = kFar_m, y_m = kFar_m, z_m = kFar_m;
    float zero = 0.0F;
  };
  Eigen::Vector3f position_m(int slot) const {
    const Position& p = positions_[slot];
    return {p.x_m, p.y_m, p.z_m};
  }
  void move_towards(int slot, const Eigen::Vector3f& target_m, float rate);
  const Position* positions() const { return positions_.data(); }

  /// Puts a node without edges into the lowest free slot and returns it. Needs num_nodes <
  /// max_nodes.
  int add_node(const Eigen::Vector3f& position_m);
  /// Removes the node and its edges.
  void remove_node(int slot);

  /// The edges of one node. The age is not stored but follows from the two ends' wins, so that
  /// ageing costs one increment: age = wins[a] + wins[b] - born, in 16 bits; max_edge_age keeps
  /// true ages far below the wrap.
  struct alignas(64) Links {
    std::array<std::uint16_t, kDegreeLimit + 1> neighbour;  ///< kNobody from degree on
    std::array<std::uint16_t, kDegreeLimit> born{};
    std::uint16_t degree = 0;

    Links() { neighbour.fill(kNobody); }
  };
  static constexpr std::uint16_t kNobody = 0xFFFF;

  int degree(int slot) const { return links_[slot].degree; }
  /// Slots in no particular order; valid until the next change.
  std::span<const std::uint16_t> neighbours(int slot) const {
    return {links_[slot].neighbour.data(), static_cast<std::size_t>(links_[slot].degree)};
  }
  bool joined(int a, int b) const { return find(a, b) >= 0; }
  /// Of the edge to neighbours(slot)[k].
  int age(int slot, int k) const {
    const Links& links = links_[slot];
    return static_cast<std::uint16_t>(wins_[slot] + wins_[links.neighbour[k]] - links.born[k]);
  }
  /// One more win: every edge of the node gets one older.
  void age_edges(int slot) { ++wins_[slot]; }
  /// Joins a != b with age 0, or makes their edge young again. An end that is full gives up its
  /// oldest edge (of equals the one to the lowest slot). Returns the number of edges given up.
  int join(int a, int b);
  void separate(int a, int b);

  // For the signal step (growing_signals.cpp), which does the frequent part itself.
  Links& links(int slot) { return links_[slot]; }
  const Links& links(int slot) const { return links_[slot]; }
  std::uint16_t* wins() { return wins_.data(); }
  Position* positions() { return positions_.data(); }

 private:
  int find(int a, int b) const;
  void drop_half(int a, int k);
  void add_half(int a, int b);
  void drop_oldest(int slot);

  int max_nodes_;
  int max_degree_;
  int num_nodes_ = 0;
  int num_slots_ = 0;
  int lowest_free_ = 0;
  int next_id_ = 0;
  std::vector<Position> positions_;
  std::vector<int> id_;
  std::vector<std::uint16_t> wins_;
  std::vector<Links> links_;
  std::vector<int> order_;  // scratch of renumber()
};

}  // namespace ddgng
