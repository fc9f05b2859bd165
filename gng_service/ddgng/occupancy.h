// SPDX-License-Identifier: BSD-3-Clause
// Where nodes may be, in one bit per cube of space: answers "none near here" without looking at any
// node. Periodic and never cleared by a node that leaves, so "maybe" can be wrong, "none" cannot.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "ddgng/cell_grid.h"

namespace ddgng {

class Occupancy {
 public:
  Occupancy() : rows_(kRows * kRows) {}

  /// Forgets all marks; cubes of this side from now on.
  void clear(float side_m) {
    per_side_ = 1.0F / side_m;
    std::fill(rows_.begin(), rows_.end(), std::uint64_t{0});
  }

  /// A node is here.
  void mark(const Eigen::Vector3f& position_m) {
    const int cx = CellGrid::floor_to_int(position_m.x() * per_side_);
    const int cy = CellGrid::floor_to_int(position_m.y() * per_side_);
    const int cz = CellGrid::floor_to_int(position_m.z() * per_side_);
    row(cy, cz) |= std::uint64_t{1} << (cx & 63);
  }

  /// False: no mark within this distance of the point. O((radius / side)^2). Both in reach of
  /// exact float cells (see WinnerSearch).
  bool maybe_within(const Eigen::Vector3f& point_m, float radius_m) const {
    constexpr float kSlack = 1e-3F;  // of a side, for rounding
    const float r = radius_m * per_side_ + kSlack;
    const Eigen::Vector3f f = point_m * per_side_;
    const int x0 = CellGrid::floor_to_int(f.x() - r);
    const int x1 = CellGrid::floor_to_int(f.x() + r);
    const int z1 = CellGrid::floor_to_int(f.z() + r);
    const int y1 = CellGrid::floor_to_int(f.y() + r);
    if (x1 - x0 >= kRows - 1) return true;
    std::uint64_t mask = (std::uint64_t{2} << (x1 - x0)) - 1;
    const int shift = x0 & 63;
    if (shift > 0) mask = mask << shift | mask >> (64 - shift);
    for (int cz = CellGrid::floor_to_int(f.z() - r); cz <= z1; ++cz) {
      for (int cy = CellGrid::floor_to_int(f.y() - r); cy <= y1; ++cy) {
        if ((row(cy, cz) & mask) != 0) return true;
      }
    }
    return false;
  }

 private:
  static constexpr int kRows = 32;  // periods of y and z; that of x is 64, one word
  std::uint64_t& row(int cy, int cz) {
    return rows_[(cz & (kRows - 1)) * kRows + (cy & (kRows - 1))];
  }
  const std::uint64_t& row(int cy, int cz) const {
    return rows_[(cz & (kRows - 1)) * kRows + (cy & (kRows - 1))];
  }

  float per_side_ = 1.0F;
  std::vector<std::uint64_t> rows_;
};

}  // namespace ddgng
