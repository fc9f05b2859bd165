// SPDX-License-Identifier: BSD-3-Clause
#include "ddgng/cell_grid.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "ddgng/graph.h"

namespace ddgng {
namespace {

// A little more than needed: a node on the border of two cells does not go to and fro.
constexpr float kReach = 1.002F;

}  // namespace

CellGrid::CellGrid(int num_slots)
    : cells_(std::min(num_slots + 1, Graph::kNodeLimit + 1)), places_(num_slots) {
  // Few nodes share an entry by chance.
  constexpr int kEntriesPerNode = 8;
  while ((1 << table_bits_) < kEntriesPerNode * num_slots) ++table_bits_;
  for (Level& level : levels_) {
    level.mask = (1U << table_bits_) - 1;
    level.table.resize(std::size_t{1} << table_bits_);
  }
  free_.reserve(cells_.size());
  clear();
}

void CellGrid::clear() {
  ++layout_;
  for (Level& level : levels_) {
    level.side_m = level.per_side = 1.0F;
    level.num_nodes = 0;
    std::fill(level.table.begin(), level.table.end(), std::uint16_t{0});
  }
  Cell empty{};
  for (int lane = 0; lane < kLanes; ++lane) clear_lane(empty, lane);
  std::fill(cells_.begin(), cells_.end(), empty);
  std::fill(places_.begin(), places_.end(), Place{});
  free_.clear();
  for (std::size_t i = cells_.size() - 1; i > 0; --i) {
    free_.push_back(static_cast<std::uint16_t>(i));
  }
}

void CellGrid::clear_lane(Cell& cell, int lane) {
  cell.x_m[lane] = cell.y_m[lane] = cell.z_m[lane] = Graph::kFar_m;
  cell.used = static_cast<std::uint16_t>(cell.used & ~(1 << lane));
}

std::uint16_t CellGrid::take_cell() {
  CHECK(!free_.empty(), "more cells than nodes");
  const std::uint16_t index = free_.back();
  free_.pop_back();
  return index;
}

// Reach: what its cell and the finer grid's cell have in common. Returns the coordinates of its
// cell.
std::array<int, 3> CellGrid::set_reach(Place& place, const Eigen::Vector3f& position_m) const {
  const Level& own = levels_[place.level];
  const Level& finer = levels_[0].side_m < levels_[1].side_m ? levels_[0] : levels_[1];
  std::array<int, 3> cell{};
  for (int axis = 0; axis < 3; ++axis) {
    cell[axis] = floor_to_int(in_sides(position_m[axis], own.per_side, axis));
    const int part = floor_to_int(in_sides(position_m[axis], finer.per_side, axis));
    const auto low = [axis](const Level& level, int c) {
      return (static_cast<float>(c) - kShift[axis]) * level.side_m;
    };
    const float low_m = std::max(low(own, cell[axis]), low(finer, part));
    const float high_m = std::min(low(own, cell[axis] + 1), low(finer, part + 1));
    place.center_m[axis] = 0.5F * (low_m + high_m);
    place.reach_m[axis] = kReach * 0.5F * (high_m - low_m);
  }
  return cell;
}

// Into the cell that follows from the node's position and level.
void CellGrid::put(int slot, const Eigen::Vector3f& position_m) {
  Place& place = places_[slot];
  Level& level = levels_[place.level];
  const std::array<int, 3> c = set_reach(place, position_m);
  ++layout_;
  place.entry = level.entry(c[0], c[1], c[2]);
  std::uint16_t& start = level.table[place.entry];
  start &= kIndex;
  std::uint16_t* link = &start;
  while (*link != 0 && cells_[*link].used == 0xFFFF) link = &cells_[*link].next;
  if (*link == 0) *link = take_cell();
  Cell& cell = cells_[*link];
  int lane = 0;
  while ((cell.used >> lane & 1) != 0) ++lane;
  cell.x_m[lane] = position_m.x();
  cell.y_m[lane] = position_m.y();
  cell.z_m[lane] = position_m.z();
  cell.slot[lane] = static_cast<std::uint16_t>(slot);
  cell.used = static_cast<std::uint16_t>(cell.used | 1 << lane);
  place.cell = *link;
  mark_whether_it_goes_on(start);
  place.lane = static_cast<std::uint16_t>(lane);
  ++level.num_nodes;
}

void CellGrid::mark_whether_it_goes_on(std::uint16_t& start) const {
  if (cells_[start].next != 0) start |= kGoesOn;
}

void CellGrid::take_out(int slot) {
  Place& place = places_[slot];
  Level& level = levels_[place.level];
  Cell& cell = cells_[place.cell];
  ++layout_;
  clear_lane(cell, place.lane);
  if (cell.used == 0) release_cell(level, place.entry, place.cell);
  place.cell = 0;
  --level.num_nodes;
}

void CellGrid::release_cell(Level& level, std::uint32_t entry, std::uint16_t index) {
  std::uint16_t& start = level.table[entry];
  start &= kIndex;
  std::uint16_t* link = &start;
  while (*link != index) link = &cells_[*link].next;
  *link = cells_[index].next;
  cells_[index].next = 0;
  mark_whether_it_goes_on(start);
  free_.push_back(index);
}

void CellGrid::add(int slot, int level, const Eigen::Vector3f& position_m) {
  places_[slot].level = level;
  put(slot, position_m);
}

void CellGrid::remove(int slot) {
  take_out(slot);
}

bool CellGrid::move(int slot, const Eigen::Vector3f& position_m) {
  Place& place = places_[slot];
  bool in_reach = true;
  for (int axis = 0; axis < 3; ++axis) {
    const float off_m = std::abs(position_m[axis] - place.center_m[axis]);
    in_reach = in_reach && off_m <= place.reach_m[axis];
  }
  if (!in_reach) {
    const std::array<int, 3> c = set_reach(place, position_m);
    if (place.entry != levels_[place.level].entry(c[0], c[1], c[2])) {
      take_out(slot);
      put(slot, position_m);
      return true;
    }
  }
  Cell& cell = cells_[place.cell];
  cell.x_m[place.lane] = position_m.x();
  cell.y_m[place.lane] = position_m.y();
  cell.z_m[place.lane] = position_m.z();
  return !in_reach;
}

void CellGrid::resize(int level, float side_m) {
  levels_[level].side_m = side_m;
  levels_[level].per_side = 1.0F / side_m;
  for (int slot = 0; slot < static_cast<int>(places_.size()); ++slot) {
    const Place& place = places_[slot];
    if (place.cell == 0) continue;
    const Cell& cell = cells_[place.cell];
    const Eigen::Vector3f position_m(cell.x_m[place.lane], cell.y_m[place.lane],
                                     cell.z_m[place.lane]);
    take_out(slot);
    put(slot, position_m);
  }
}

}  // namespace ddgng
