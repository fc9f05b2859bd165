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

/// Looks at every slot. Needs at least two nodes. O(slots).
Winners nearest_two_linear(const Graph& graph, const Eigen::Vector3f& signal_m);

/// The same answer from a few cells. Density differs by a factor of 100 and more between the
/// suspected area and the rest, so each has a grid of its own; where the cells cannot prove their
/// answer, all slots are looked at. Must be told of every change of the graph.
class WinnerSearch {
 public:
  explicit WinnerSearch(int num_slots);

  void clear();
  /// For comparison: from now on every answer comes from all slots, and no cells are kept.
  void search_linearly() { linear_only_ = true; }
  void add(int slot, bool inside, const Eigen::Vector3f& position_m) {
    if (linear_only_) return;
    grids_[inside ? 1 : 0].add(slot, position_m);
    if (inside) inside_nodes_.mark(position_m);
  }
  void remove(int slot, bool inside) {
    if (!linear_only_) grids_[inside ? 1 : 0].remove(slot);
  }
  void move(int slot, bool inside, const Eigen::Vector3f& position_m) {
    if (linear_only_) return;
    grids_[inside ? 1 : 0].move(slot, position_m);
    if (inside) inside_nodes_.mark(position_m);
  }

  Winners nearest_two(const Graph& graph, const Eigen::Vector3f& signal_m);

  /// Tells the search what it found, so that its cells follow the spacing of nodes (only speed
  /// depends on it). inside_of: per slot, 1 = in the suspected area.
  void learn_spacing(const Graph& graph, const std::uint8_t* inside_of, const Winners& winners);

  struct Counts {
    std::int64_t searches = 0;
    std::int64_t linear = 0;  ///< answered by looking at every slot
  };
  const Counts& counts() const { return counts_; }

 private:
  float fitting_side_m(int area) const;
  void refit(const Graph& graph, const std::uint8_t* inside_of, int area);
  void mark_inside(const Graph& graph, const std::uint8_t* inside_of);

  std::array<CellGrid, 2> grids_;  // outside, inside
  Occupancy inside_nodes_;         // in parts of the outside grid's cells
  std::array<float, 2> spacing_m2_{};
  std::array<int, 2> until_check_{};
  int until_mark_ = 0;
  bool linear_only_ = false;
  Counts counts_;
};

}  // namespace ddgng
