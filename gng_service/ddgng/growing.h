// SPDX-License-Identifier: BSD-3-Clause
// Growing neural gas with utility (GNG-U): what one signal does to the graph, where nodes are
// inserted and which are removed. When to insert, and where the suspected area lies, is decided by
// the caller (Algorithm 1, ddgng.cpp).
#pragma once

#include <span>

#include <Eigen/Core>

#include "ddgng/growing_state.h"
#include "ddgng/params.h"
#include "ddgng/sampler.h"
#include "ddgng/winner_search.h"

namespace ddgng {

class Growing {
 public:
  /// check(params) must be "".
  explicit Growing(const GrowingParams& params) : state_(params) {}

  void clear() { state_.clear(); }

  /// The first two nodes, not joined (the first signal joins them).
  void start(const Eigen::Vector3f& h1_m, const Eigen::Vector3f& h2_m);
  bool started() const { return graph().num_nodes() >= 2; }

  /// The first num signals one after the other, each: winners, edge, error and utility, move,
  /// ageing, decay. Writes the winners of each; they may have been removed since. The rest is what
  /// comes next: its first winners are looked for already. Needs started(). growing_signals.cpp
  void signals(std::span<const Signal> signals, std::size_t num, Winners* winners);
  void signals(std::span<const Signal> all, Winners* winners) { signals(all, all.size(), winners); }

  enum class Weighting { kError, kErrorAndStrength };
  /// A node half way between the node of the largest (weighted) error and its worst neighbour.
  /// Returns its slot, outside the suspected area until set_inside() says otherwise; -1 when the
  /// graph is full or has no edge.
  int insert(Weighting weighting);

  /// Removes the least useful node when the largest error exceeds k times its utility. Returns its
  /// slot, or -1.
  int remove_useless();

  /// Whether the node lies in the suspected area (Alg. 2).
  void set_inside(int slot, bool inside) { state_.set_inside(slot, inside); }
  bool inside(int slot) const { return state_.inside[slot] != 0; }
  int num_inside() const { return state_.num_inside; }

  const Graph& graph() const { return state_.graph; }
  float error_m2(int slot) const { return state_.error_decay.value(state_.error[slot]); }
  float utility_m2(int slot) const { return state_.utility_m2(slot); }
  float strength(int slot) const;

  using Counts = GrowingState::Counts;
  const Counts& counts() const { return state_.counts; }
  /// For comparison: the same winners, found by looking at every node.
  void search_linearly() { state_.search.search_linearly(); }
  const WinnerSearch::Counts& search_counts() const { return state_.search.counts(); }

 private:
  SlotValues values() const {
    return {state_.error.data(), state_.utility.data(), state_.inside.data()};
  }
  bool useful(float stored_error, float utility_m2) const;
  bool surely_all_useful() const;
  int largest_error(Weighting weighting);
  float weighted_error(int slot, Weighting weighting) const;

  GrowingState state_;
};

}  // namespace ddgng
