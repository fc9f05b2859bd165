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
#include <cstdint>

#include <hwy/highway.h>

#include "ddgng/winner_search.h"

HWY_BEFORE_NAMESPACE();
namespace ddgng {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr int kBlockCells = 8;
constexpr float kBorderSlack = CellGrid::kSlack + Occupancy::kSlack;  // of a side

/// The 2 x 2 x 2 cells of one level round the cell corner that is nearest to a signal.
struct Block {
  const CellGrid::Level* level;
  int cx, cy, cz;       ///< the first of them
  std::uint32_t entry;  ///< of the first
  float border_m2;      ///< no other node of the level is nearer than this, squared

  std::uint16_t cell(std::uint32_t i) const {
    const std::uint32_t off = (i & 1) + (i >> 1 & 1) * level->kPerY + (i >> 2) * level->kPerZ;
    return level->table[(entry + off) & level->mask];
  }
  /// 0 = all cells are empty; with CellGrid::kGoesOn, a cell has more nodes than lanes.
  int any() const {
    int any = 0;
    HWY_UNROLL(8)
    for (std::uint32_t i = 0; i < kBlockCells; ++i) any |= cell(i);
    return any;
  }
};

/// signal_m: x, y, z, 0, aligned. A signal beyond the reach of exact cells proves nothing.
HWY_INLINE Block BlockAround(const CellGrid::Level& level, const float* signal_m) {
  const hn::CappedTag<float, 4> d;
  const hn::RebindToSigned<decltype(d)> di;
  HWY_ALIGN std::int32_t corner[4];
  HWY_ALIGN float border[4];
  bool addressable = true;
  for (int i = 0; i < 4; i += static_cast<int>(hn::Lanes(d))) {
    const auto f = hn::Mul(hn::Load(d, signal_m + i), hn::Set(d, level.per_side));
    const auto low = hn::Floor(hn::Sub(f, hn::Set(d, 0.5F)));
    const auto u = hn::Sub(f, low);
    hn::Store(hn::ConvertTo(di, low), di, corner + i);
    hn::Store(hn::Min(u, hn::Sub(hn::Set(d, 2.0F), u)), d, border + i);
    addressable =
        addressable && hn::AllTrue(d, hn::Lt(hn::Abs(f), hn::Set(d, CellGrid::kMaxSides)));
  }
  const float inner = std::min(std::min(border[0], border[1]), border[2]) - kBorderSlack;
  const float border_m = addressable ? std::max(0.0F, inner) * level.side_m : 0.0F;
  return {&level,
          corner[0],
          corner[1],
          corner[2],
          level.entry(corner[0], corner[1], corner[2]),
          border_m * border_m};
}

/// The lanes of all cells of a block that hold a value, a bit each; true: exactly one.
struct Marks {
  std::uint64_t low = 0, high = 0;

  int first() const {
    return low != 0 ? static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero64(low))
                    : 64 + static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero64(high));
  }
  bool single() const {
    return (low == 0) != (high == 0) && ((low & (low - 1)) | (high & (high - 1))) == 0;
  }
};

template <class D>
HWY_INLINE Marks LanesOf(D d, const float* m2, hn::Vec<D> value) {
  const int num_lanes = static_cast<int>(hn::Lanes(d));
  Marks marks;
  HWY_UNROLL(32)
  for (int i = 0; i < kBlockCells * CellGrid::kLanes; i += num_lanes) {
    std::uint16_t bits = 0;  // at most 16 lanes; little-endian, as all of our machines
    hn::StoreMaskBits(d, hn::Eq(hn::Load(d, m2 + i), value),
                      reinterpret_cast<std::uint8_t*>(&bits));
    (i < 64 ? marks.low : marks.high) |= static_cast<std::uint64_t>(bits) << (i % 64);
  }
  return marks;
}

/// The nearest two nodes of a block of which no cell goes on. False: distances are equal.
HWY_INLINE bool NearestTwoOfBlock(const CellGrid::Cell* cells, const Block& block,
                                  const float* signal_m, Winners& winners) {
  const hn::CappedTag<float, CellGrid::kLanes> d;
  const int num_lanes = static_cast<int>(hn::Lanes(d));
  const auto x = hn::Set(d, signal_m[0]);
  const auto y = hn::Set(d, signal_m[1]);
  const auto z = hn::Set(d, signal_m[2]);
  HWY_ALIGN float m2[kBlockCells * CellGrid::kLanes];
  auto best = hn::Set(d, hwy::HighestValue<float>());
  auto next = best;
  HWY_UNROLL(8)
  for (std::uint32_t c = 0; c < kBlockCells; ++c) {
    const CellGrid::Cell& cell = cells[block.cell(c)];
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
  winners.first_m2 = hn::GetLane(first);
  winners.second_m2 = hn::GetLane(second);
  const Marks has_first = LanesOf(d, m2, first);
  const Marks has_second = LanesOf(d, m2, second);
  if (HWY_UNLIKELY(!has_first.single() || !has_second.single())) return false;
  const auto slot_at = [&](int lane) {
    return cells[block.cell(lane / CellGrid::kLanes)].slot[lane % CellGrid::kLanes];
  };
  winners.first = slot_at(has_first.first());
  winners.second = slot_at(has_second.first());
  return true;
}

/// signal_m: x, y, z, 0, aligned.
HWY_INLINE Winners NearestTwo(WinnerSearch& search, const Graph& graph, const float* signal_m) {
  search.count();
  Winners winners;
  winners.second_m2 = hwy::HighestValue<float>();
  const Eigen::Vector3f point_m(signal_m[0], signal_m[1], signal_m[2]);
  if (HWY_LIKELY(!search.linear_only())) {
    const CellGrid& grid = search.grid();
    int level = grid.level(1).num_nodes > 0 ? 1 : 0;
    Block block = BlockAround(grid.level(level), signal_m);
    int any = block.any();
    if (level == 1 && any == 0) {
      level = 0;
      block = BlockAround(grid.level(0), signal_m);
      any = block.any();
    }
    if (HWY_UNLIKELY((any & CellGrid::kGoesOn) != 0) ||
        HWY_UNLIKELY(!NearestTwoOfBlock(grid.cells(), block, signal_m, winners))) {
      winners = search.nearest_two_crowded(level, {block.cx, block.cy, block.cz}, point_m);
    }
    if (HWY_LIKELY(winners.second_m2 < block.border_m2) &&
        (HWY_LIKELY(!search.others_in_block(level, block.cx, block.cy, block.cz)) ||
         !search.others_within(level, point_m, winners.second_m2))) {
      return winners;
    }
  }
  return search.nearest_two_wide(graph, point_m, winners.second_m2);
}

}  // namespace HWY_NAMESPACE
}  // namespace ddgng
HWY_AFTER_NAMESPACE();

#endif
