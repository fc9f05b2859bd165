// SPDX-License-Identifier: BSD-3-Clause
// Where nodes may be, in one bit per cube of space: answers "none near here" without looking at any
// node. Periodic and never cleared by a node that leaves, so "maybe" can be wrong, "none" cannot.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "ddgng/cell_grid.h"

namespace ddgng {

class Occupancy {
 public:
  explicit Occupancy(int num_nodes) {
    std::size_t num_rows = 1024;
    while (num_rows < static_cast<std::size_t>(num_nodes)) num_rows *= 2;
    rows_.resize(num_rows);
    while ((per_z_ + 2) * (per_z_ + 2) <= num_rows) per_z_ += 2;
  }

  /// Forgets all marks; cubes of this side from now on.
  void clear(float side_m) {
    per_side_ = 1.0F / side_m;
    std::fill(rows_.begin(), rows_.end(), std::uint64_t{0});
  }

  /// A node is within these distances of the centre and stays there, but for a few percent of them.
  /// Whether that was news.
  bool mark(const Eigen::Vector3f& center_m, const Eigen::Vector3f& reach_m) {
    const Range x = range(0, center_m.x(), kMarked * reach_m.x());
    const Range y = range(1, center_m.y(), kMarked * reach_m.y());
    const Range z = range(2, center_m.z(), kMarked * reach_m.z());
    bool news = false;
    for (int cz = z.first; cz <= z.last; ++cz) {
      for (int cy = y.first; cy <= y.last; ++cy) {
        std::uint64_t& cubes = row(cy, cz);
        news = news || (cubes | mask(x)) != cubes;
        cubes |= mask(x);
      }
    }
    return news;
  }

  /// False: no node within this distance of the point on any axis. O((radius / side)^2).
  bool maybe_within(const Eigen::Vector3f& point_m, float radius_m) const {
    const float reach_m = radius_m + kSlack / per_side_;
    const Range x = range(0, point_m.x(), reach_m);
    const Range y = range(1, point_m.y(), reach_m);
    const Range z = range(2, point_m.z(), reach_m);
    if (y.last - y.first >= kMaxWidth || z.last - z.first >= kMaxWidth) return true;
    for (int cz = z.first; cz <= z.last; ++cz) {
      for (int cy = y.first; cy <= y.last; ++cy) {
        if ((row(cy, cz) & mask(x)) != 0) return true;
      }
    }
    return false;
  }

  float per_side() const { return per_side_; }
  /// False: no node in this cube, except within kSlack of its border.
  bool maybe_in_cube(int cx, int cy, int cz) const { return (row(cy, cz) & mask({cx, cx})) != 0; }
  /// False: no node in the 2 x 2 x 2 cubes from this one on, except within kSlack of their border.
  bool maybe_in_block(int cx, int cy, int cz) const {
    const std::uint64_t rows =
        row(cy, cz) | row(cy + 1, cz) | row(cy, cz + 1) | row(cy + 1, cz + 1);
    return (rows & mask({cx, cx + 1})) != 0;
  }

  static constexpr float kSlack = 0.02F;  ///< of a side

 private:
  static constexpr int kMaxWidth = 64;
  // Less than reached, so that a node which fills a cube does not mark the cubes round it.
  static constexpr float kMarked = 0.98F;

  struct Range {
    int first = 0, last = 0;
  };
  Range range(int axis, float center_m, float reach_m) const {
    return {CellGrid::floor_to_int(CellGrid::in_sides(center_m - reach_m, per_side_, axis)),
            CellGrid::floor_to_int(CellGrid::in_sides(center_m + reach_m, per_side_, axis))};
  }
  static std::uint64_t mask(const Range& x) {
    if (x.last - x.first >= 63) return ~std::uint64_t{0};
    const std::uint64_t mask = (std::uint64_t{2} << (x.last - x.first)) - 1;
    return std::rotl(mask, x.first & 63);
  }
  // A row of 64 cubes along x. Rows far apart share a word: nearly as far as can be, because per_z_
  // is odd and close to the root of their number.
  std::size_t row_index(int cy, int cz) const {
    return (static_cast<std::uint32_t>(cy) + static_cast<std::uint32_t>(cz) * per_z_) &
           (rows_.size() - 1);
  }
  std::uint64_t& row(int cy, int cz) { return rows_[row_index(cy, cz)]; }
  const std::uint64_t& row(int cy, int cz) const { return rows_[row_index(cy, cz)]; }

  float per_side_ = 1.0F;
  std::uint32_t per_z_ = 1;
  std::vector<std::uint64_t> rows_;
};

}  // namespace ddgng
