// SPDX-License-Identifier: BSD-3-Clause
// Compiled once per instruction set by Highway; the best one of the machine is chosen at run time.
#include "ddgng/winner_search.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ddgng/winner_search.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#ifndef DDGNG_WINNER_SEARCH_ONCE
#define DDGNG_WINNER_SEARCH_ONCE
#include <cmath>

namespace ddgng {

// The cells that one search looks at, and its answer.
struct CellList {
  static constexpr int kMax = 32;
  std::array<const CellGrid::Cell*, kMax> cells;
  int num = 0;
  bool overflow = false;
};

}  // namespace ddgng
#endif

HWY_BEFORE_NAMESPACE();
namespace ddgng {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Each lane keeps the two best of its own column; a strict comparison over ascending slots leaves
// the lowest slot of equals. The columns are merged by (distance, slot) at the end.
Winners NearestTwo(const Graph& graph, const Eigen::Vector3f& signal_m) {
  const hn::CappedTag<float, Graph::kSlotBlock> d;
  const hn::RebindToSigned<decltype(d)> di;
  constexpr int kMaxLanes = Graph::kSlotBlock;
  const int num_lanes = static_cast<int>(hn::Lanes(d));
  const auto x = hn::Set(d, signal_m.x());
  const auto y = hn::Set(d, signal_m.y());
  const auto z = hn::Set(d, signal_m.z());
  auto best = hn::Set(d, hwy::HighestValue<float>());
  auto next = best;
  auto best_slot = hn::Set(di, -1);
  auto next_slot = best_slot;
  auto slot = hn::Iota(di, 0);
  const auto step = hn::Set(di, num_lanes);
  for (int i = 0; i < graph.num_slots(); i += num_lanes) {
    const auto dx = hn::Sub(hn::LoadU(d, graph.x_m() + i), x);
    const auto dy = hn::Sub(hn::LoadU(d, graph.y_m() + i), y);
    const auto dz = hn::Sub(hn::LoadU(d, graph.z_m() + i), z);
    const auto m2 = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
    const auto wins = hn::Lt(m2, best);
    const auto follows = hn::Lt(m2, next);
    next = hn::IfThenElse(wins, best, hn::IfThenElse(follows, m2, next));
    next_slot = hn::IfThenElse(hn::RebindMask(di, wins), best_slot,
                               hn::IfThenElse(hn::RebindMask(di, follows), slot, next_slot));
    best = hn::IfThenElse(wins, m2, best);
    best_slot = hn::IfThenElse(hn::RebindMask(di, wins), slot, best_slot);
    slot = hn::Add(slot, step);
  }
  float m2[2 * kMaxLanes];
  std::int32_t slots[2 * kMaxLanes];
  hn::StoreU(best, d, m2);
  hn::StoreU(next, d, m2 + num_lanes);
  hn::StoreU(best_slot, di, slots);
  hn::StoreU(next_slot, di, slots + num_lanes);
  Winners winners{-1, -1, hwy::HighestValue<float>(), hwy::HighestValue<float>()};
  for (int k = 0; k < 2 * num_lanes; ++k) {
    if (slots[k] < 0) continue;
    const auto before = [&](int other, float other_m2) {
      return m2[k] < other_m2 || (m2[k] == other_m2 && (other < 0 || slots[k] < other));
    };
    if (before(winners.first, winners.first_m2)) {
      winners.second = winners.first;
      winners.second_m2 = winners.first_m2;
      winners.first = slots[k];
      winners.first_m2 = m2[k];
    } else if (before(winners.second, winners.second_m2)) {
      winners.second = slots[k];
      winners.second_m2 = m2[k];
    }
  }
  return winners;
}

// Of the marked lanes the one with the lowest slot, except one slot; -1 = none.
HWY_INLINE int LowestSlot(const CellList& list, const std::uint64_t* marks, int num_words,
                          int lanes_per_byte, int except) {
  int lowest = -1;
  for (int word = 0; word < num_words; ++word) {
    for (std::uint64_t bits = marks[word]; bits != 0; bits &= bits - 1) {
      const int bit = 64 * word + static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero64(bits));
      const int lane = bit / 8 * lanes_per_byte + bit % 8;
      const int slot = list.cells[lane / CellGrid::kLanes]->slot[lane % CellGrid::kLanes];
      if (slot != except && (lowest < 0 || slot < lowest)) lowest = slot;
    }
  }
  return lowest;
}

// The nearest two of all nodes in the list; second_m2 is huge when there are fewer. First the two
// smallest distances (with multiplicity), then which lanes have them.
Winners NearestTwoInCells(const CellList& list, const Eigen::Vector3f& signal_m) {
  const hn::CappedTag<float, CellGrid::kLanes> d;
  const int num_lanes = static_cast<int>(hn::Lanes(d));
  const auto x = hn::Set(d, signal_m.x());
  const auto y = hn::Set(d, signal_m.y());
  const auto z = hn::Set(d, signal_m.z());
  HWY_ALIGN float m2[CellList::kMax * CellGrid::kLanes];
  auto best = hn::Set(d, hwy::HighestValue<float>());
  auto next = best;
  float* out = m2;
  for (int c = 0; c < list.num; ++c) {
    const CellGrid::Cell& cell = *list.cells[c];
    for (int i = 0; i < CellGrid::kLanes; i += num_lanes) {
      const auto dx = hn::Sub(hn::Load(d, cell.x_m.data() + i), x);
      const auto dy = hn::Sub(hn::Load(d, cell.y_m.data() + i), y);
      const auto dz = hn::Sub(hn::Load(d, cell.z_m.data() + i), z);
      const auto v = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
      hn::Store(v, d, out);
      out += num_lanes;
      next = hn::Min(next, hn::Max(best, v));
      best = hn::Min(best, v);
    }
  }
  Winners winners;
  const auto first = hn::MinOfLanes(d, best);
  const auto has_first = hn::Eq(best, first);
  const auto second = hn::CountTrue(d, has_first) > 1
                          ? first
                          : hn::MinOfLanes(d, hn::IfThenElse(has_first, next, best));
  winners.first_m2 = hn::GetLane(first);
  winners.second_m2 = hn::GetLane(second);

  // One bit per lane; vectors of fewer than 8 lanes fill the low bits of a byte (a scalar: one).
  constexpr int kMaxWords = CellList::kMax * CellGrid::kLanes / 8;
  std::uint64_t first_marks[kMaxWords + 1];
  std::uint64_t second_marks[kMaxWords + 1];
  const int lanes_per_byte = num_lanes < 8 ? num_lanes : 8;
  const int num_words = (list.num * CellGrid::kLanes / lanes_per_byte + 7) / 8;
  first_marks[num_words - 1] = second_marks[num_words - 1] = 0;
  auto* first_byte = reinterpret_cast<std::uint8_t*>(first_marks);
  auto* second_byte = reinterpret_cast<std::uint8_t*>(second_marks);
  for (const float* in = m2; in != out; in += num_lanes) {
    const auto v = hn::Load(d, in);
    first_byte += hn::StoreMaskBits(d, hn::Eq(v, first), first_byte);
    second_byte += hn::StoreMaskBits(d, hn::Eq(v, second), second_byte);
  }
  winners.first = LowestSlot(list, first_marks, num_words, lanes_per_byte, -1);
  winners.second = LowestSlot(list, second_marks, num_words, lanes_per_byte, winners.first);
  return winners;
}

}  // namespace HWY_NAMESPACE
}  // namespace ddgng
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ddgng {
namespace {

HWY_EXPORT(NearestTwo);
HWY_EXPORT(NearestTwoInCells);

// Cells this many RMS second distances wide: few nodes per block of cells, few linear fallbacks.
// Not swept.
constexpr float kSidePerSpacing = 2.6F;
constexpr float kMinSide_m = 1e-3F;
constexpr float kOccupancyPart = 0.25F;  // of the outside grid's side
// Where a node lies in its cell is known to this part of a side: rounding of |f| < kMaxSides.
constexpr float kSlack = 1e-3F;
constexpr float kMaxSides = 4000.0F;

void push(CellList& list, const CellGrid& grid, std::uint16_t index) {
  for (; index != 0; index = grid.cell(index).next) {
    if (list.num == CellList::kMax) {
      list.overflow = true;
      return;
    }
    list.cells[list.num++] = &grid.cell(index);
  }
}

bool addressable(const Eigen::Vector3f& f) {
  return f.cwiseAbs().maxCoeff() < kMaxSides;  // false for NaN
}

// Adds the 2 x 2 x 2 cells around the nearest cell corner; returns the squared distance [m2] below
// which no node outside of them can be.
float push_block(CellList& list, const CellGrid& grid, const Eigen::Vector3f& signal_m) {
  const Eigen::Vector3f f = signal_m * grid.per_side();
  if (!addressable(f)) return 0.0F;
  const int cx = CellGrid::floor_to_int(f.x() - 0.5F);
  const int cy = CellGrid::floor_to_int(f.y() - 0.5F);
  const int cz = CellGrid::floor_to_int(f.z() - 0.5F);
  for (int i = 0; i < 8; ++i) {
    push(list, grid, grid.first(cx + (i & 1), cy + (i >> 1 & 1), cz + (i >> 2)));
  }
  const Eigen::Vector3f u =
      f - Eigen::Vector3f(static_cast<float>(cx), static_cast<float>(cy), static_cast<float>(cz));
  const float border = std::min(u.minCoeff(), 2.0F - u.maxCoeff()) - kSlack;
  const float border_m = std::max(0.0F, border) * grid.side_m();
  return border_m * border_m;
}

// The same for the one cell that holds the signal.
float push_cell(CellList& list, const CellGrid& grid, const Eigen::Vector3f& signal_m) {
  const Eigen::Vector3f f = signal_m * grid.per_side();
  if (!addressable(f)) return 0.0F;
  const int cx = CellGrid::floor_to_int(f.x());
  const int cy = CellGrid::floor_to_int(f.y());
  const int cz = CellGrid::floor_to_int(f.z());
  push(list, grid, grid.first(cx, cy, cz));
  const Eigen::Vector3f u =
      f - Eigen::Vector3f(static_cast<float>(cx), static_cast<float>(cy), static_cast<float>(cz));
  const float border = std::min(u.minCoeff(), 1.0F - u.maxCoeff()) - kSlack;
  const float border_m = std::max(0.0F, border) * grid.side_m();
  return border_m * border_m;
}

}  // namespace

Winners nearest_two_linear(const Graph& graph, const Eigen::Vector3f& signal_m) {
  return HWY_DYNAMIC_DISPATCH(NearestTwo)(graph, signal_m);
}

WinnerSearch::WinnerSearch(int num_slots) : grids_{CellGrid(num_slots), CellGrid(num_slots)} {
  clear();
}

void WinnerSearch::clear() {
  for (CellGrid& grid : grids_) grid.clear(1.0F);
  inside_nodes_.clear(kOccupancyPart);
  spacing_m2_ = {};
  until_check_ = {16, 16};
  until_mark_ = 0;
  counts_ = {};
}

Winners WinnerSearch::nearest_two(const Graph& graph, const Eigen::Vector3f& signal_m) {
  ++counts_.searches;
  if (linear_only_) {
    ++counts_.linear;
    return nearest_two_linear(graph, signal_m);
  }
  const auto& [outside, inside] = grids_;
  CellList list;
  const float inside_m2 =
      inside.num_nodes() == 0 ? hwy::HighestValue<float>() : push_block(list, inside, signal_m);
  // In the dense area a single cell of the sparse grid usually proves that nothing else is near.
  if (list.num > 0) {
    const int num_inside_cells = list.num;
    const float outside_m2 =
        outside.num_nodes() == 0 ? hwy::HighestValue<float>() : push_cell(list, outside, signal_m);
    if (!list.overflow) {
      const Winners winners = HWY_DYNAMIC_DISPATCH(NearestTwoInCells)(list, signal_m);
      if (winners.second_m2 < std::min(inside_m2, outside_m2)) return winners;
    }
    list.num = num_inside_cells;
  }
  const float outside_m2 = push_block(list, outside, signal_m);
  if (list.num > 0 && !list.overflow) {
    const Winners winners = HWY_DYNAMIC_DISPATCH(NearestTwoInCells)(list, signal_m);
    if (winners.second_m2 < outside_m2 &&
        (winners.second_m2 < inside_m2 ||
         !inside_nodes_.maybe_within(signal_m, std::sqrt(winners.second_m2)))) {
      return winners;
    }
  }
  ++counts_.linear;
  return nearest_two_linear(graph, signal_m);
}

float WinnerSearch::fitting_side_m(int area) const {
  return std::max(kMinSide_m, kSidePerSpacing * std::sqrt(spacing_m2_[area]));
}

void WinnerSearch::learn_spacing(const Graph& graph, const std::uint8_t* inside_of,
                                 const Winners& winners) {
  if (linear_only_) return;
  const int area = inside_of[winners.first];
  spacing_m2_[area] += (winners.second_m2 - spacing_m2_[area]) * (1.0F / 64.0F);
  if (--until_check_[area] <= 0) {
    until_check_[area] = 256;
    const float ratio = fitting_side_m(area) * grids_[area].per_side();
    if (ratio < 0.75F || ratio > 1.33F) refit(graph, inside_of, area);
  }
  if (--until_mark_ <= 0) mark_inside(graph, inside_of);
}

void WinnerSearch::refit(const Graph& graph, const std::uint8_t* inside_of, int area) {
  grids_[area].clear(fitting_side_m(area));
  for (int slot = 0; slot < graph.num_slots(); ++slot) {
    if (!graph.alive(slot) || inside_of[slot] != area) continue;
    grids_[area].add(slot, graph.position_m(slot));
  }
  if (area == 0) mark_inside(graph, inside_of);
}

// Forgets the places that nodes have left.
void WinnerSearch::mark_inside(const Graph& graph, const std::uint8_t* inside_of) {
  until_mark_ = std::max(1024, 4 * graph.num_slots());
  inside_nodes_.clear(kOccupancyPart * grids_[0].side_m());
  for (int slot = 0; slot < graph.num_slots(); ++slot) {
    if (graph.alive(slot) && inside_of[slot] != 0) inside_nodes_.mark(graph.position_m(slot));
  }
}

}  // namespace ddgng
#endif
