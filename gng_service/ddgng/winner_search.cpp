// SPDX-License-Identifier: BSD-3-Clause
// Compiled once per instruction set by Highway; the best one of the machine is chosen at run time.
#include "ddgng/winner_search.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ddgng/winner_search.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

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

}  // namespace HWY_NAMESPACE
}  // namespace ddgng
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ddgng {
HWY_EXPORT(NearestTwo);

Winners nearest_two_linear(const Graph& graph, const Eigen::Vector3f& signal_m) {
  return HWY_DYNAMIC_DISPATCH(NearestTwo)(graph, signal_m);
}

}  // namespace ddgng
#endif
