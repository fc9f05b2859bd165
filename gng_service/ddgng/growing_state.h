// SPDX-License-Identifier: BSD-3-Clause
// The graph together with what belongs to its nodes (error, utility, area) and must change with
// them. The steps of the algorithm are in growing.cpp and growing_signals.cpp.
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

struct GrowingState {
  explicit GrowingState(const GrowingParams& growing_params);

  void clear();

  /// A new node, outside the suspected area. error and utility as stored.
  int place(const Eigen::Vector3f& position_m, float stored_error, float stored_utility);
  void remove(int slot);
  /// The edges of the winner that are older than max_edge_age, and nodes that lose their last edge.
  void remove_old_edges(int s1);
  /// When the decays have grown too far.
  void shrink();
  void set_inside(int slot, bool inside_now);

  const Decay& decay_of(int slot) const { return utility_decay[inside[slot]]; }
  float utility_m2(int slot) const { return decay_of(slot).value(utility[slot]); }

  GrowingParams params;
  float inside_weight;
  Graph graph;
  WinnerSearch search;
  // Over slots, as stored by their decays.
  std::vector<float> error, utility;
  std::vector<std::uint8_t> inside;
  Extremes extremes;
  Decay error_decay;
  Decay utility_decay[2];  ///< outside, inside
  int num_inside = 0;

  /// Since clear().
  struct Counts {
    std::int64_t signals = 0;
    std::int64_t inserted = 0;
    std::int64_t removed_by_age = 0;
    std::int64_t removed_by_utility = 0;
    std::int64_t edges_dropped = 0;  ///< given up because a node was full
  };
  Counts counts;
};

}  // namespace ddgng
