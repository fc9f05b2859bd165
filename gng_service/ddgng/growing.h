// SPDX-License-Identifier: BSD-3-Clause
// Growing neural gas with utility (GNG-U): what one signal does to the graph, where nodes are
// inserted and which are removed. When to insert, and where the suspected area lies, is decided by
// the caller (Algorithm 1, ddgng.cpp).
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "ddgng/decay.h"
#include "ddgng/extremes.h"
#include "ddgng/graph.h"
#include "ddgng/params.h"
#include "ddgng/winner_search.h"

namespace ddgng {

class Growing {
 public:
  /// check(params) must be "".
  explicit Growing(const GrowingParams& params);

  void clear();

  /// The first two nodes, not joined (the first signal joins them).
  void start(const Eigen::Vector3f& h1_m, const Eigen::Vector3f& h2_m);
  bool started() const { return graph_.num_nodes() >= 2; }

  /// One signal: winners, edge, error and utility, move, ageing, decay. Needs started().
  Winners signal(const Eigen::Vector3f& signal_m);

  enum class Weighting { kError, kErrorAndStrength };
  /// A node half way between the node of the largest (weighted) error and its worst neighbour.
  /// Returns its slot, outside the suspected area until set_inside() says otherwise; -1 when the
  /// graph is full or has no edge.
  int insert(Weighting weighting);

  /// Removes the least useful node when the largest error exceeds k times its utility. Returns its
  /// slot, or -1.
  int remove_useless();

  /// Whether the node lies in the suspected area (Alg. 2).
  void set_inside(int slot, bool inside);
  bool inside(int slot) const { return inside_[slot] != 0; }
  int num_inside() const { return num_inside_; }

  const Graph& graph() const { return graph_; }
  float error_m2(int slot) const { return error_decay_.value(error_[slot]); }
  float utility_m2(int slot) const { return decay_of(slot).value(utility_[slot]); }
  float strength(int slot) const;

  /// Since clear().
  struct Counts {
    std::int64_t signals = 0;
    std::int64_t inserted = 0;
    std::int64_t removed_by_age = 0;
    std::int64_t removed_by_utility = 0;
    std::int64_t edges_dropped = 0;  ///< given up because a node was full
  };
  const Counts& counts() const { return counts_; }
  /// For comparison: the same winners, found by looking at every node.
  void search_linearly() { search_.search_linearly(); }
  const WinnerSearch::Counts& search_counts() const { return search_.counts(); }

 private:
  const Decay& decay_of(int slot) const { return utility_decay_[inside_[slot]]; }
  void move_towards(int slot, const Eigen::Vector3f& signal_m, float rate);
  void remove_old_edges(int s1);
  void fade();
  void remove(int slot);
  SlotValues values() const { return {error_.data(), utility_.data(), inside_.data()}; }
  int place(const Eigen::Vector3f& position_m, float error, float utility);
  int largest_error(Weighting weighting);
  float weighted_error(int slot, Weighting weighting) const;

  GrowingParams params_;
  float inside_weight_;
  Graph graph_;
  WinnerSearch search_;
  // Over slots, as stored by their decays.
  std::vector<float> error_, utility_;
  std::vector<std::uint8_t> inside_;
  Extremes extremes_;
  Decay error_decay_;
  Decay utility_decay_[2];  // outside, inside
  int num_inside_ = 0;
  Counts counts_;
};

}  // namespace ddgng
