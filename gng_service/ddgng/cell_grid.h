// SPDX-License-Identifier: BSD-3-Clause
// Two uniform grids of cubic cells over space (density differs by a factor of 100 and more between
// the suspected area and the rest, so each has its own side) with small tables: cells far apart
// may share a table entry and with it their nodes. Holds copies of node positions, 16 to a cell,
// laid out for SIMD. Only stores; the search is in winner_search.h.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace ddgng {

class CellGrid {
 public:
  static constexpr int kLanes = 16;
  static constexpr std::uint16_t kIndex = 0x7FFF;
  static constexpr std::uint16_t kGoesOn = 0x8000;
  static constexpr int kNumLevels = 2;  ///< outside and inside the suspected area

  /// Empty lanes lie at Graph::kFar_m. A cell with more nodes goes on in next (0 = ends here).
  struct alignas(64) Cell {
    std::array<float, kLanes> x_m, y_m, z_m;
    std::array<std::uint16_t, kLanes> slot;
    std::uint16_t used;  ///< bit per lane
    std::uint16_t next;
  };

  /// Where a node is. Nobody need be told while it stays within reach of a centre on every axis:
  /// then it is still in its cell, and in the same cell of the finer grid. The fourth elements are
  /// 0.
  struct alignas(16) Place {
    std::array<float, 4> center_m{};
    std::array<float, 4> reach_m{};
    std::uint16_t cell = 0;
    std::uint16_t lane = 0;
    std::uint32_t entry = 0;
    int level = 0;
  };

  /// One grid: what is needed to find the cells round a point. Cells whose coordinates differ by a
  /// vector of a lattice share a table entry. The lattice lies aslant, so that floors, walls and
  /// posts do not fall upon themselves.
  struct Level {
    float side_m = 1.0F;
    float per_side = 1.0F;
    int num_nodes = 0;
    std::uint32_t mask = 0;
    std::vector<std::uint16_t> table;

    static constexpr std::uint32_t kPerY = 249015;
    static constexpr std::uint32_t kPerZ = 55423;
    std::uint32_t entry(int cx, int cy, int cz) const {
      return (static_cast<std::uint32_t>(cx) + static_cast<std::uint32_t>(cy) * kPerY +
              static_cast<std::uint32_t>(cz) * kPerZ) &
             mask;
    }
    /// The first cell at these cell coordinates; index 0 = no node there; kGoesOn added = there is
    /// a next cell.
    std::uint16_t first(int cx, int cy, int cz) const { return table[entry(cx, cy, cz)]; }
  };
  static constexpr int kMinTableBits = 9;
  static constexpr int kMaxTableBits = 18;
  /// In a cube of so many cells all have entries of their own; for tables of 2^9 ... 2^18 entries.
  static constexpr std::array<int, kMaxTableBits - kMinTableBits + 1> kDistinct = {
      4, 7, 7, 14, 16, 21, 24, 33, 35, 51};
  int num_distinct() const { return kDistinct[table_bits_ - kMinTableBits]; }

  /// A node lies at most this part of a side outside of its cell (because of reach, and of rounding
  /// while coordinates are below kMaxSides).
  static constexpr float kSlack = 2e-3F;
  static constexpr float kMaxSides = 4000.0F;
  /// Cells do not begin at 0 but these parts of a side before, for x, y, z: a floor at height 0
  /// with its noise lies within one layer of cells, not on the border of two.
  alignas(16) static constexpr std::array<float, 4> kShift = {0.0F, 0.0F, 0.25F, 0.0F};

  explicit CellGrid(int num_slots);

  /// Forgets all nodes.
  void clear();

  void add(int slot, int level, const Eigen::Vector3f& position_m);
  void remove(int slot);
  /// Moves the node, if need be into another cell. True: it is out of reach of the former centre.
  bool move(int slot, const Eigen::Vector3f& position_m);
  /// Cells of this side from now on.
  void resize(int level, float side_m);

  /// Changes whenever a node comes into another cell.
  std::uint32_t layout() const { return layout_; }

  const Level& level(int index) const { return levels_[index]; }
  const Cell* cells() const { return cells_.data(); }
  const Place& place(int slot) const { return places_[slot]; }
  const Place* places() const { return places_.data(); }

  // For the signal step, which moves nodes itself as long as they stay in their cells.
  Cell* cells() { return cells_.data(); }
  Place* places() { return places_.data(); }

  /// Coordinate in cell sides; its floor is the cell's coordinate.
  static float in_sides(float m, float per_side, int axis) { return m * per_side + kShift[axis]; }
  /// |f| < 2^31.
  static int floor_to_int(float f) {
    const int whole = static_cast<int>(f);
    return static_cast<float>(whole) > f ? whole - 1 : whole;
  }

 private:
  std::array<int, 3> set_reach(Place& place, const Eigen::Vector3f& position_m) const;
  void put(int slot, const Eigen::Vector3f& position_m);
  void take_out(int slot);
  void mark_whether_it_goes_on(std::uint16_t& start) const;
  std::uint16_t take_cell();
  void clear_lane(Cell& cell, int lane);
  void release_cell(Level& level, std::uint32_t entry, std::uint16_t index);

  std::uint32_t layout_ = 0;
  int table_bits_ = kMinTableBits;
  std::array<Level, kNumLevels> levels_;
  std::vector<Cell> cells_;  // of both grids; cells_[0] stays empty
  std::vector<std::uint16_t> free_;
  std::vector<Place> places_;  // per slot; cell 0 = no node
};

}  // namespace ddgng
