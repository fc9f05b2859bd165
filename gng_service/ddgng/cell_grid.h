// SPDX-License-Identifier: BSD-3-Clause
// A uniform grid of cubic cells over space, periodic so that its table is small: cells one period
// apart share a table entry and with it their nodes. Holds copies of node positions, 16 to a cell,
// laid out for SIMD. Only stores; the search is in winner_search.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace ddgng {

class CellGrid {
 public:
  static constexpr int kLanes = 16;

  /// Empty lanes lie at Graph::kFar_m. A cell with more nodes goes on in next (0 = ends here).
  struct alignas(64) Cell {
    std::array<float, kLanes> x_m, y_m, z_m;
    std::array<std::uint16_t, kLanes> slot;
    std::uint16_t used;  ///< bit per lane
    std::uint16_t next;
  };

  explicit CellGrid(int num_slots);

  /// Forgets all nodes.
  void clear(float side_m);

  float side_m() const { return side_m_; }
  float per_side() const { return per_side_; }
  int num_nodes() const { return num_nodes_; }

  void add(int slot, const Eigen::Vector3f& position_m);
  void remove(int slot);
  void move(int slot, const Eigen::Vector3f& position_m);

  /// The first cell of the table entry; index 0 = no node there. Any coordinates.
  std::uint16_t first(int cx, int cy, int cz) const { return table_[entry(cx, cy, cz)]; }
  const Cell& cell(std::uint16_t index) const { return cells_[index]; }

  /// Cell coordinate of a coordinate in cell sides, |f| < 2^31.
  static int floor_to_int(float f) {
    const int whole = static_cast<int>(f);
    return static_cast<float>(whole) > f ? whole - 1 : whole;
  }

 private:
  struct Place {
    int cx = 0, cy = 0, cz = 0;
    std::uint16_t cell = 0;
    std::uint16_t lane = 0;
  };

  int entry(int cx, int cy, int cz) const {
    return (cx & mask_) | (cy & mask_) << bits_ | (cz & mask_) << (2 * bits_);
  }
  std::uint16_t take_cell();
  void clear_lane(Cell& cell, int lane);
  void release_cell(int table_entry, std::uint16_t index);

  int bits_ = 1;
  int mask_ = 1;
  float side_m_ = 1.0F;
  float per_side_ = 1.0F;
  int num_nodes_ = 0;
  std::vector<std::uint16_t> table_;
  std::vector<Cell> cells_;  // cells_[0] stays empty
  std::vector<std::uint16_t> free_;
  std::vector<Place> places_;  // per slot
};

}  // namespace ddgng
