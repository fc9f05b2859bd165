// SPDX-License-Identifier: BSD-3-Clause
// The two nodes nearest to a signal (first and second winner), exactly: the distance of every node
// counts as (dx dx + dy dy) + dz dz rounded in float, ties go to the lowest slot, and every
// instruction set gives the same answer.
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

#include "ddgng/cell_grid.h"
#include "ddgng/graph.h"
#include "ddgng/occupancy.h"

namespace ddgng {

struct Winners {
  int first = -1;   ///< s1, slot
  int second = -1;  ///< s2, slot
  float first_m2 = 0.0F;
  float second_m2 = 0.0F;
};

/// One search on its way: the cells to look at (ListCells), then the answer (NearestTwo).
struct Query {
  static constexpr int kBlockCells = 8;

  Graph::Position signal_m;
  // Of the 2 x 2 x 2 cells round the signal:
  std::array<std::uint16_t, kBlockCells> cells{};  ///< those with nodes first
  int num_cells = 0;
  int level = 0;
  alignas(16) std::array<std::int32_t, 4> corner{};  ///< the first of the eight
  float border_m2 = 0.0F;    ///< no other node of the level is nearer than this, squared
  bool crowded = false;      ///< they go on in more cells than fit
  std::uint32_t layout = 0;  ///< CellGrid::layout() when they were listed

  Winners winners;
};

/// Looks at every slot. Needs at least two nodes. O(slots).
Winners nearest_two_linear(const Graph& graph, const Eigen::Vector3f& signal_m);

/// The same answer from the few cells round the signal: first from a block of eight
/// (nearest_two_inl.h); where that cannot prove its answer, from all cells that a ball of the
/// second distance touches; where those are too many, from all slots. Must be told of every change
/// of the graph.
class WinnerSearch {
 public:
  explicit WinnerSearch(int num_slots);

  void clear();
  /// For comparison: from now on every answer comes from all slots, and no cells are kept.
  void search_linearly() { linear_only_ = true; }
  bool linear_only() const { return linear_only_; }

  void add(int slot, bool inside, const Eigen::Vector3f& position_m);
  void remove(int slot);
  void move(int slot, const Eigen::Vector3f& position_m);

  Winners nearest_two(const Graph& graph, const Eigen::Vector3f& signal_m);

  /// Tells the search an answer now and then, so that its cells follow the spacing of nodes (only
  /// speed depends on it).
  void learn_spacing(const Graph& graph, const Winners& winners);

  struct Counts {
    std::int64_t searches = 0;
    std::int64_t wide = 0;    ///< not answered by the block of cells alone
    std::int64_t linear = 0;  ///< answered by looking at every slot
  };
  const Counts& counts() const { return counts_; }

  // For the search in the nearest cells, compiled into the signal step.
  CellGrid& grid() { return grid_; }
  const CellGrid& grid() const { return grid_; }
  void count() { ++counts_.searches; }
  /// Changes whenever a node comes, goes or changes its area.
  std::uint32_t changes() const { return changes_; }
  /// Whether nodes of the other level may be in the 2 x 2 x 2 cells of this one from these on,
  /// except close to their border.
  bool others_in_block(int level, int cx, int cy, int cz) const {
    return others_[level].maybe_in_block(cx, cy, cz);
  }
  const Occupancy& inside_parts() const { return inside_parts_; }
  bool others_within(int level, const Eigen::Vector3f& point_m, float distance_m2) const;
  /// The nearest two nodes in 2 x 2 x 2 cells when these hold many or at equal distances.
  /// second_m2 is huge when there are fewer, or too many to list.
  Winners nearest_two_crowded(int level, const std::array<std::int32_t, 4>& c,
                              const Eigen::Vector3f& signal_m);
  /// The answer when the nearest cells could not prove theirs, which found a second node at this
  /// distance (or none: infinite).
  Winners nearest_two_wide(const Graph& graph, const Eigen::Vector3f& signal_m, float second_m2);

 private:
  bool list_ball(const Eigen::Vector3f& signal_m, float second_m2, struct CellList& list) const;
  void mark(int slot);
  float fitting_side_m(int level) const;
  void mark_all(const Graph& graph, int level);

  CellGrid grid_;
  // Where the nodes of the other level may be, in cubes as large as the cells of this one.
  std::array<Occupancy, CellGrid::kNumLevels> others_;
  Occupancy inside_parts_;  // the nodes inside, in cubes of a quarter of the outside's cells
  std::array<float, CellGrid::kNumLevels> spacing_m2_{};
  std::array<int, CellGrid::kNumLevels> until_check_{};
  std::array<int, CellGrid::kNumLevels> until_mark_{};  // cubes that nodes of the level come into
  std::uint32_t changes_ = 0;
  bool linear_only_ = false;
  Counts counts_;
};

}  // namespace ddgng
