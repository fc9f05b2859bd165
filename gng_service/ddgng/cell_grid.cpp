// SPDX-License-Identifier: BSD-3-Clause
#include "ddgng/cell_grid.h"

#include <algorithm>

#include "base/check.h"
#include "ddgng/graph.h"

namespace ddgng {

CellGrid::CellGrid(int num_slots) : cells_(num_slots + 1), places_(num_slots) {
  // Four entries per node keep surfaces that pass each other apart.
  while (bits_ < 6 && (1 << (3 * bits_)) < 4 * num_slots) ++bits_;
  mask_ = (1 << bits_) - 1;
  table_.resize(std::size_t{1} << (3 * bits_));
  free_.reserve(cells_.size());
  clear(1.0F);
}

void CellGrid::clear(float side_m) {
  side_m_ = side_m;
  per_side_ = 1.0F / side_m;
  num_nodes_ = 0;
  std::fill(table_.begin(), table_.end(), std::uint16_t{0});
  Cell empty{};
  for (int lane = 0; lane < kLanes; ++lane) clear_lane(empty, lane);
  std::fill(cells_.begin(), cells_.end(), empty);
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

void CellGrid::add(int slot, const Eigen::Vector3f& position_m) {
  Place& place = places_[slot];
  place.cx = floor_to_int(position_m.x() * per_side_);
  place.cy = floor_to_int(position_m.y() * per_side_);
  place.cz = floor_to_int(position_m.z() * per_side_);
  std::uint16_t* link = &table_[entry(place.cx, place.cy, place.cz)];
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
  place.lane = static_cast<std::uint16_t>(lane);
  ++num_nodes_;
}

void CellGrid::remove(int slot) {
  const Place& place = places_[slot];
  Cell& cell = cells_[place.cell];
  clear_lane(cell, place.lane);
  if (cell.used == 0) release_cell(entry(place.cx, place.cy, place.cz), place.cell);
  --num_nodes_;
}

void CellGrid::release_cell(int table_entry, std::uint16_t index) {
  std::uint16_t* link = &table_[table_entry];
  while (*link != index) link = &cells_[*link].next;
  *link = cells_[index].next;
  cells_[index].next = 0;
  free_.push_back(index);
}

void CellGrid::move(int slot, const Eigen::Vector3f& position_m) {
  const Place& place = places_[slot];
  const bool stays = floor_to_int(position_m.x() * per_side_) == place.cx &&
                     floor_to_int(position_m.y() * per_side_) == place.cy &&
                     floor_to_int(position_m.z() * per_side_) == place.cz;
  if (!stays) {
    remove(slot);
    add(slot, position_m);
    return;
  }
  Cell& cell = cells_[place.cell];
  cell.x_m[place.lane] = position_m.x();
  cell.y_m[place.lane] = position_m.y();
  cell.z_m[place.lane] = position_m.z();
}

}  // namespace ddgng
