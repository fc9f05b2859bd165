// SPDX-License-Identifier: BSD-3-Clause
// The graph together with what belongs to its nodes (error, utility, area) and must change with
// them. The steps of the algorithm are in growing.cpp and growing_signals.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "ddgng/decay.h"
#include "ddgng/extremes.h"
#include "ddgng/graph.h"
#include "ddgng/params.h"
#include "ddgng/winner_search.h"

namespace ddgng {

/// A signal to come: the search for it runs ahead of the changes that the signals before it make,
/// so that the processor overlaps the two, and is repeated where these touch its answer.
struct Ahead {
  Query query;
  bool found = false;         ///< query.winners stand
  std::uint32_t changes = 0;  ///< WinnerSearch::changes() when they were found

  bool is_of(const Eigen::Vector3f& signal_m) const {
    const auto& [x_m, y_m, z_m, zero] = query.signal_m;
    return signal_m == Eigen::Vector3f(x_m, y_m, z_m);
  }
};

struct GrowingState {
  explicit GrowingState(const GrowingParams& growing_params);

  void clear();

  /// A new node, outside the suspected area. error and utility as stored.
  int place(const Eigen::Vector3f& position_m, float stored_error, float stored_utility);
  void remove(int slot);
  /// The edges of the winner that are older than max_edge_age, and nodes that lose their last edge.
  void remove_old_edges(int s1);
  bool shrink_due() const {
    return error_decay.shrink_due() || utility_decay[0].shrink_due() ||
           utility_decay[1].shrink_due();
  }
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
  std::array<Ahead, 4> ahead;  ///< in turns: of this signal, of the next, ...
  std::uint32_t turn = 0;      ///< of the signal that comes
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
