// SPDX-License-Identifier: BSD-3-Clause
// The winner search in the nearest cells, to be compiled into whatever needs it, once per
// instruction set (therefore no #pragma once, but Highway's way to include again).
#if defined(DDGNG_NEAREST_TWO_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DDGNG_NEAREST_TWO_INL_H
#undef DDGNG_NEAREST_TWO_INL_H
#else
#define DDGNG_NEAREST_TWO_INL_H
#endif

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <hwy/highway.h>

#include "ddgng/winner_search.h"

HWY_BEFORE_NAMESPACE();
namespace ddgng {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr float kBorderSlack = CellGrid::kSlack + Occupancy::kSlack;  // of a side

/// A point in cell sides, from this axis on.
template <class D>
HWY_INLINE hn::Vec<D> InSides(D d, const Graph::Position& point_m, int axis, float per_side) {
  return hn::Add(hn::Mul(hn::Load(d, &point_m.x_m + axis), hn::Set(d, per_side)),
                 hn::Load(d, CellGrid::kShift.data() + axis));
}

/// Adds the cells in which those listed go on.
inline HWY_NOINLINE void ListNext(const CellGrid& grid, Query& query) {
  for (int i = 0; i < query.num_cells; ++i) {
    query.cells[i] &= CellGrid::kIndex;
    const std::uint16_t next = grid.cells()[query.cells[i]].next;
    if (next == 0) continue;
    query.crowded = query.num_cells == Query::kBlockCells;
    if (query.crowded) return;
    query.cells[query.num_cells++] = next;
  }
}

/// Lists the cells that hold nodes among the 2 x 2 x 2 of one level round the cell corner that is
/// nearest to the signal. A signal beyond the reach of exact cells proves nothing (border 0).
HWY_INLINE void ListBlock(const CellGrid& grid, int index, Query& query) {
  const CellGrid::Level& level = grid.level(index);
  const hn::CappedTag<float, 4> d;
  const hn::RebindToSigned<decltype(d)> di;
  HWY_ALIGN float border[4];
  bool addressable = true;
  for (int i = 0; i < 4; i += static_cast<int>(hn::Lanes(d))) {
    const auto f = InSides(d, query.signal_m, i, level.per_side);
    const auto low = hn::Floor(hn::Sub(f, hn::Set(d, 0.5F)));
    const auto u = hn::Sub(f, low);
    hn::Store(hn::ConvertTo(di, low), di, query.corner.data() + i);
    hn::Store(hn::Min(u, hn::Sub(hn::Set(d, 2.0F), u)), d, border + i);
    addressable =
        addressable && hn::AllTrue(d, hn::Lt(hn::Abs(f), hn::Set(d, CellGrid::kMaxSides)));
  }
  const float inner = std::min(std::min(border[0], border[1]), border[2]) - kBorderSlack;
  const float border_m = addressable ? std::max(0.0F, inner) * level.side_m : 0.0F;
  query.border_m2 = border_m * border_m;
  query.level = index;

  const std::uint32_t entry = level.entry(query.corner[0], query.corner[1], query.corner[2]);
  const std::uint16_t* const table = level.table.data();
  int any = 0;
  std::size_t num = 0;
  query.cells = {};
  HWY_UNROLL(8)  // without branches: the next one overwrites an empty one
  for (std::uint32_t i = 0; i < Query::kBlockCells; ++i) {
    const std::uint32_t off = (i & 1) + (i >> 1 & 1) * level.kPerY + (i >> 2) * level.kPerZ;
    const std::uint16_t first = table[(entry + off) & level.mask];
    query.cells[num] = first;
    num += first != 0 ? 1 : 0;
    any |= first;
  }
  query.num_cells = static_cast<int>(num);
  query.crowded = false;
  if (HWY_UNLIKELY((any & CellGrid::kGoesOn) != 0)) ListNext(grid, query);
  query.layout = grid.layout();
}

/// Whether a node of the inside may be in the small cube that holds the signal.
HWY_INLINE bool MaybeInside(const Occupancy& inside_parts, const Query& query) {
  const hn::CappedTag<float, 4> d;
  const hn::RebindToSigned<decltype(d)> di;
  HWY_ALIGN std::int32_t cube[4];
  for (int i = 0; i < 4; i += static_cast<int>(hn::Lanes(d))) {
    const auto f = InSides(d, query.signal_m, i, inside_parts.per_side());
    hn::Store(hn::ConvertTo(di, hn::Floor(f)), di, cube + i);
  }
  return inside_parts.maybe_in_cube(cube[0], cube[1], cube[2]);
}

/// From the cells of one level, chosen without a branch (which nobody could predict); from those of
/// the other where they hold no node.
HWY_INLINE void ListCells(const WinnerSearch& search, Query& query) {
  const int level = MaybeInside(search.inside_parts(), query) ? 1 : 0;
  ListBlock(search.grid(), level, query);
  if (HWY_UNLIKELY(query.num_cells == 0)) ListBlock(search.grid(), 1 - level, query);
}

/// The lanes of the listed cells that hold a value, a bit each.
template <int kNumCells>
struct Marks {
  static constexpr int kNumWords = (kNumCells * CellGrid::kLanes + 63) / 64;
  std::uint64_t words[kNumWords] = {};

  bool single() const {
    std::size_t num = 0;
    for (const std::uint64_t word : words) num += hwy::PopCount(word);
    return num == 1;
  }
  /// Needs single().
  int lane() const {
    const int word = words[0] == 0 ? kNumWords - 1 : 0;
    return 64 * word + static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero64(words[word]));
  }
};

template <int kNumCells, class D>
HWY_INLINE Marks<kNumCells> LanesOf(D d, const float* m2, hn::Vec<D> value) {
  const int num_lanes = static_cast<int>(hn::Lanes(d));
  Marks<kNumCells> marks;
  HWY_UNROLL(32)
  for (int i = 0; i < kNumCells * CellGrid::kLanes; i += num_lanes) {
    std::uint16_t bits = 0;  // at most 16 lanes; little-endian, as all of our machines
    hn::StoreMaskBits(d, hn::Eq(hn::Load(d, m2 + i), value),
                      reinterpret_cast<std::uint8_t*>(&bits));
    marks.words[i / 64] |= static_cast<std::uint64_t>(bits) << (i % 64);
  }
  return marks;
}

/// The nearest two nodes of the first cells listed (those unused are empty). False: distances are
/// equal.
template <int kNumCells>
HWY_INLINE bool NearestTwoOfCells(const CellGrid::Cell* cells, Query& query) {
  const hn::CappedTag<float, CellGrid::kLanes> d;
  const int num_lanes = static_cast<int>(hn::Lanes(d));
  const auto x = hn::Set(d, query.signal_m.x_m);
  const auto y = hn::Set(d, query.signal_m.y_m);
  const auto z = hn::Set(d, query.signal_m.z_m);
  HWY_ALIGN float m2[kNumCells * CellGrid::kLanes];
  auto best = hn::Set(d, hwy::HighestValue<float>());
  auto next = best;
  HWY_UNROLL(8)
  for (int c = 0; c < kNumCells; ++c) {
    const CellGrid::Cell& cell = cells[query.cells[c]];
    HWY_UNROLL(4)
    for (int i = 0; i < CellGrid::kLanes; i += num_lanes) {
      const auto dx = hn::Sub(hn::Load(d, cell.x_m.data() + i), x);
      const auto dy = hn::Sub(hn::Load(d, cell.y_m.data() + i), y);
      const auto dz = hn::Sub(hn::Load(d, cell.z_m.data() + i), z);
      const auto v = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
      hn::Store(v, d, m2 + c * CellGrid::kLanes + i);
      next = hn::Min(next, hn::Max(best, v));
      best = hn::Min(best, v);
    }
  }
  const auto first = hn::MinOfLanes(d, best);
  const auto second = hn::MinOfLanes(d, hn::IfThenElse(hn::Eq(best, first), next, best));
  Winners& winners = query.winners;
  winners.first_m2 = hn::GetLane(first);
  winners.second_m2 = hn::GetLane(second);
  const auto has_first = LanesOf<kNumCells>(d, m2, first);
  const auto has_second = LanesOf<kNumCells>(d, m2, second);
  if (HWY_UNLIKELY(!has_first.single() || !has_second.single())) return false;
  const auto slot_at = [&](int lane) {
    return cells[query.cells[lane / CellGrid::kLanes]].slot[lane % CellGrid::kLanes];
  };
  winners.first = slot_at(has_first.lane());
  winners.second = slot_at(has_second.lane());
  return true;
}

HWY_INLINE bool NearestTwoOfCells(const CellGrid::Cell* cells, Query& query) {
  if (query.num_cells <= 4) return NearestTwoOfCells<4>(cells, query);
  return NearestTwoOfCells<Query::kBlockCells>(cells, query);
}

/// The nearest two of four nodes.
inline Winners Merged(Winners a, Winners b) {
  const auto before = [](float a_m2, int a_slot, float b_m2, int b_slot) {
    return a_m2 < b_m2 || (a_m2 == b_m2 && a_slot < b_slot);
  };
  if (before(b.first_m2, b.first, a.first_m2, a.first)) std::swap(a, b);
  if (before(b.first_m2, b.first, a.second_m2, a.second)) {
    a.second = b.first;
    a.second_m2 = b.first_m2;
  }
  return a;
}

/// The answer when the listed cells could not prove theirs; their border may have been wide enough.
inline HWY_NOINLINE void NearestTwoWide(WinnerSearch& search, const Graph& graph, Query& query) {
  float second_m2 = query.winners.second_m2;
  const bool proved = second_m2 < query.border_m2;  // but for the other level
  if (query.level == 1) {  // near the border of the inside, nodes outside are often nearer
    Query outside = query;
    ListBlock(search.grid(), 0, outside);
    if (!outside.crowded && NearestTwoOfCells(search.grid().cells(), outside)) {
      if (proved && second_m2 < outside.border_m2) {
        query.winners = Merged(query.winners, outside.winners);
        return;
      }
      second_m2 = std::min(second_m2, outside.winners.second_m2);
    }
  }
  const auto [x_m, y_m, z_m, zero] = query.signal_m;
  query.winners = search.nearest_two_wide(graph, {x_m, y_m, z_m}, second_m2);
}

/// Needs ListCells(); what has changed since is taken into account.
HWY_INLINE void NearestTwo(WinnerSearch& search, const Graph& graph, Query& query) {
  const CellGrid& grid = search.grid();
  if (HWY_UNLIKELY(query.layout != grid.layout())) ListCells(search, query);
  search.count();
  const auto [x_m, y_m, z_m, zero] = query.signal_m;
  const Eigen::Vector3f point_m(x_m, y_m, z_m);
  if (HWY_UNLIKELY(query.crowded) || HWY_UNLIKELY(!NearestTwoOfCells(grid.cells(), query))) {
    query.winners = search.nearest_two_crowded(query.level, query.corner, point_m);
  }
  const float second_m2 = query.winners.second_m2;
  const auto [cx, cy, cz, unused] = query.corner;
  if (HWY_LIKELY(second_m2 < query.border_m2) &&
      (HWY_LIKELY(!search.others_in_block(query.level, cx, cy, cz)) ||
       !search.others_within(query.level, point_m, second_m2))) {
    return;
  }
  NearestTwoWide(search, graph, query);
}

}  // namespace HWY_NAMESPACE
}  // namespace ddgng
HWY_AFTER_NAMESPACE();

#endif
