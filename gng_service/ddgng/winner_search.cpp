// SPDX-License-Identifier: BSD-3-Clause
// Compiled once per instruction set by Highway; the best one of the machine is chosen at run time.
#include "ddgng/winner_search.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ddgng/winner_search.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "ddgng/nearest_two_inl.h"

#ifndef DDGNG_WINNER_SEARCH_ONCE
#define DDGNG_WINNER_SEARCH_ONCE
#include <cmath>

namespace ddgng {

// The cells that one search looks at, and its answer.
struct CellList {
  static constexpr int kMax = 64;
  std::array<const CellGrid::Cell*, kMax> cells;
  int num = 0;

  /// False: full.
  bool push(const CellGrid& grid, std::uint16_t index) {
    for (index &= CellGrid::kIndex; index != 0; index = grid.cells()[index].next) {
      if (num == kMax) return false;
      cells[num++] = &grid.cells()[index];
    }
    return true;
  }
};

}  // namespace ddgng
#endif

HWY_BEFORE_NAMESPACE();
namespace ddgng {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Each lane keeps the two best of its own column; a strict comparison over ascending slots leaves
// the lowest slot of equals. The columns are merged by (distance, slot) at the end.
Winners NearestTwoOfAll(const Graph& graph, const Eigen::Vector3f& signal_m) {
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
    auto x_m = hn::Zero(d);
    auto y_m = hn::Zero(d);
    auto z_m = hn::Zero(d);
    auto zero = hn::Zero(d);
    hn::LoadInterleaved4(d, &graph.positions()[i].x_m, x_m, y_m, z_m, zero);
    const auto dx = hn::Sub(x_m, x);
    const auto dy = hn::Sub(y_m, y);
    const auto dz = hn::Sub(z_m, z);
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

Winners NearestTwoInGrid(WinnerSearch& search, const Graph& graph, const Eigen::Vector3f& v) {
  Query query;
  query.signal_m = {v.x(), v.y(), v.z(), 0.0F};
  ListCells(search, query);
  NearestTwo(search, graph, query);
  return query.winners;
}

}  // namespace HWY_NAMESPACE
}  // namespace ddgng
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ddgng {
namespace {

HWY_EXPORT(NearestTwoOfAll);
HWY_EXPORT(NearestTwoInCells);
HWY_EXPORT(NearestTwoInGrid);

// Cells this many RMS second distances wide: few nodes per block of cells, few wide searches.
constexpr float kSidePerSpacing = 3.0F;
constexpr float kMinSide_m = 1e-3F;
constexpr float kPart = 0.25F;
// A wide search looks at no more entries of the table than one for so many nodes.
constexpr int kNodesPerEntry = 8;

}  // namespace

Winners nearest_two_linear(const Graph& graph, const Eigen::Vector3f& signal_m) {
  return HWY_DYNAMIC_DISPATCH(NearestTwoOfAll)(graph, signal_m);
}

WinnerSearch::WinnerSearch(int num_slots)
    : grid_(num_slots),
      others_{Occupancy(num_slots), Occupancy(num_slots)},
      inside_parts_(num_slots) {
  clear();
}

void WinnerSearch::clear() {
  grid_.clear();
  ++changes_;
  for (Occupancy& others : others_) others.clear(1.0F);
  inside_parts_.clear(kPart);
  spacing_m2_ = {};
  until_check_ = {16, 16};
  until_mark_ = {};
  counts_ = {};
}

void WinnerSearch::add(int slot, bool inside, const Eigen::Vector3f& position_m) {
  if (linear_only_) return;
  ++changes_;
  grid_.add(slot, inside ? 1 : 0, position_m);
  mark(slot);
}

void WinnerSearch::remove(int slot) {
  if (linear_only_) return;
  ++changes_;
  grid_.remove(slot);
}

void WinnerSearch::move(int slot, const Eigen::Vector3f& position_m) {
  if (!linear_only_ && grid_.move(slot, position_m)) mark(slot);
}

void WinnerSearch::mark(int slot) {
  const CellGrid::Place& place = grid_.place(slot);
  const Eigen::Vector3f center_m(place.center_m.data());
  const Eigen::Vector3f reach_m(place.reach_m.data());
  if (others_[1 - place.level].mark(center_m, reach_m)) --until_mark_[place.level];
  if (place.level == 1) inside_parts_.mark(center_m, reach_m);
}

bool WinnerSearch::others_within(int level, const Eigen::Vector3f& point_m,
                                 float distance_m2) const {
  const float distance_m = std::sqrt(distance_m2);
  return level == 0 ? inside_parts_.maybe_within(point_m, distance_m)
                    : others_[1].maybe_within(point_m, distance_m);
}

Winners WinnerSearch::nearest_two(const Graph& graph, const Eigen::Vector3f& signal_m) {
  if (linear_only_) return nearest_two_linear(graph, signal_m);
  return HWY_DYNAMIC_DISPATCH(NearestTwoInGrid)(*this, graph, signal_m);
}

Winners WinnerSearch::nearest_two_crowded(int level, const std::array<std::int32_t, 4>& c,
                                          const Eigen::Vector3f& signal_m) {
  Winners none;
  none.second_m2 = hwy::HighestValue<float>();
  CellList list;
  for (int i = 0; i < 8; ++i) {
    const std::uint16_t first =
        grid_.level(level).first(c[0] + (i & 1), c[1] + (i >> 1 & 1), c[2] + (i >> 2));
    if (!list.push(grid_, first)) return none;
  }
  return list.num > 0 ? HWY_DYNAMIC_DISPATCH(NearestTwoInCells)(list, signal_m) : none;
}

Winners WinnerSearch::nearest_two_wide(const Graph& graph, const Eigen::Vector3f& signal_m,
                                       float second_m2) {
  ++counts_.wide;
  CellList list;
  if (list_ball(signal_m, second_m2, list)) {
    return HWY_DYNAMIC_DISPATCH(NearestTwoInCells)(list, signal_m);
  }
  ++counts_.linear;
  return nearest_two_linear(graph, signal_m);
}

// All cells of both levels that a ball round the signal touches; false: too many.
bool WinnerSearch::list_ball(const Eigen::Vector3f& signal_m, float second_m2,
                             CellList& list) const {
  const float radius_m = std::sqrt(second_m2);
  for (int index = 0; index < CellGrid::kNumLevels; ++index) {
    const CellGrid::Level& level = grid_.level(index);
    const float sides = radius_m * level.per_side;
    const Eigen::Vector3f f = signal_m * level.per_side + Eigen::Vector3f(CellGrid::kShift.data());
    if (!(f.cwiseAbs().maxCoeff() + sides < CellGrid::kMaxSides)) return false;  // also NaN
    if (level.num_nodes == 0) continue;
    if (index == 1 && !inside_parts_.maybe_within(signal_m, radius_m)) continue;
    if (index == 0 && !others_[1].maybe_within(signal_m, radius_m)) continue;
    const float reach = sides + CellGrid::kSlack;
    std::array<int, 3> low{};
    std::array<int, 3> high{};
    int num_cells = 1;
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = CellGrid::floor_to_int(f[axis] - reach);
      high[axis] = CellGrid::floor_to_int(f[axis] + reach);
      const int width = high[axis] - low[axis] + 1;
      if (width > grid_.num_distinct()) return false;  // a cell would be looked at twice
      num_cells *= width;
    }
    if (kNodesPerEntry * num_cells > level.num_nodes + 256) return false;
    for (int cz = low[2]; cz <= high[2]; ++cz) {
      for (int cy = low[1]; cy <= high[1]; ++cy) {
        for (int cx = low[0]; cx <= high[0]; ++cx) {
          if (!list.push(grid_, level.first(cx, cy, cz))) return false;
        }
      }
    }
  }
  return list.num > 0;
}

float WinnerSearch::fitting_side_m(int level) const {
  return std::max(kMinSide_m, kSidePerSpacing * std::sqrt(spacing_m2_[level]));
}

void WinnerSearch::learn_spacing(const Graph& graph, const Winners& winners) {
  if (linear_only_ || !graph.alive(winners.first)) return;
  const int level = grid_.place(winners.first).level;
  spacing_m2_[level] += (winners.second_m2 - spacing_m2_[level]) * (1.0F / 64.0F);
  if (--until_check_[level] <= 0) {
    until_check_[level] = 64;
    const float ratio = fitting_side_m(level) * grid_.level(level).per_side;
    if (ratio < 0.87F || ratio > 1.15F) {
      grid_.resize(level, fitting_side_m(level));
      until_mark_ = {};
    }
  }
  for (int marked = 0; marked < CellGrid::kNumLevels; ++marked) {
    if (until_mark_[marked] <= 0) mark_all(graph, marked);
  }
}

// Marks the nodes of a level anew and so forgets the places that they have left.
void WinnerSearch::mark_all(const Graph& graph, int level) {
  others_[1 - level].clear(grid_.level(1 - level).side_m);
  if (level == 1) inside_parts_.clear(kPart * grid_.level(0).side_m);
  for (int slot = 0; slot < graph.num_slots(); ++slot) {
    if (graph.alive(slot) && grid_.place(slot).level == level) mark(slot);
  }
  until_mark_[level] = 64 + grid_.level(level).num_nodes;
}

}  // namespace ddgng
#endif
