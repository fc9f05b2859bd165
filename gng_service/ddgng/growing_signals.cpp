// SPDX-License-Identifier: BSD-3-Clause
// What signals do to the graph: the inner loop of everything. Compiled once per instruction set by
// Highway, with the winner search in it; the best one of the machine is chosen at run time.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "ddgng/growing.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ddgng/growing_signals.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "ddgng/nearest_two_inl.h"

HWY_BEFORE_NAMESPACE();
namespace ddgng {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Index of a neighbour in a node's list, -1 = none.
HWY_INLINE int IndexOf(const Graph::Links& links, int neighbour) {
  const hn::CappedTag<std::uint16_t, 32> d;
  const auto wanted = hn::Set(d, static_cast<std::uint16_t>(neighbour));
  int index = -1;
  for (int i = 0; i < 32; i += static_cast<int>(hn::Lanes(d))) {
    const auto equal = hn::Eq(hn::Load(d, links.neighbour.data() + i), wanted);
    const auto found = static_cast<int>(hn::FindFirstTrue(d, equal));
    if (found >= 0) index = i + found;
  }
  return index;
}

/// The search for the next signal runs ahead of the changes that this one makes, so that the two
/// overlap in the processor. It still stands when it found none of the moved nodes and none of them
/// has come as near as what it found.
struct Ahead {
  HWY_ALIGN float signal_m[4];
  float radius_m = -1.0F;  ///< a little more than to its second winner; negative = no search
  bool disturbed = false;
};

HWY_INLINE void SearchAhead(GrowingState& state, const Signal& signal, Ahead& ahead,
                            Winners& winners) {
  constexpr float kMargin = 1.0001F;  // more than rounding
  // As a whole: a vector read from where single elements were just written would wait for them.
  static_assert(offsetof(Signal, position_m) == 0 && sizeof(Signal) == 4 * sizeof(float));
  const hn::CappedTag<float, 4> d;
  for (int i = 0; i < 4; i += static_cast<int>(hn::Lanes(d))) {
    const auto* const from = reinterpret_cast<const float*>(&signal) + i;
    const auto coordinates = hn::FirstN(d, static_cast<std::size_t>(std::max(0, 3 - i)));
    hn::Store(hn::IfThenElseZero(coordinates, hn::LoadU(d, from)), d, ahead.signal_m + i);
  }
  winners = NearestTwo(state.search, state.graph, ahead.signal_m);
  ahead.radius_m = kMargin * std::sqrt(winners.second_m2);
  ahead.disturbed = false;
}

/// Moves a node a part of the way to a target (x, y, z, 0).
HWY_INLINE void Move(GrowingState& state, int slot, const float* target_m, float rate,
                     Ahead& ahead) {
  if (HWY_UNLIKELY(state.search.linear_only())) {
    state.graph.move_towards(slot, {target_m[0], target_m[1], target_m[2]}, rate);
    ahead.disturbed = true;
    return;
  }
  CellGrid& grid = state.search.grid();
  CellGrid::Place& place = grid.places()[slot];
  const hn::CappedTag<float, 4> d;
  bool in_reach = true;
  bool near_next = true;
  for (int i = 0; i < 4; i += static_cast<int>(hn::Lanes(d))) {
    const auto old = hn::Load(d, place.position_m.data() + i);
    const auto way = hn::Sub(hn::Load(d, target_m + i), old);
    const auto moved = hn::Add(old, hn::Mul(hn::Set(d, rate), way));
    hn::Store(moved, d, place.position_m.data() + i);
    const auto off = hn::Abs(hn::Sub(moved, hn::Load(d, place.center_m.data() + i)));
    in_reach = in_reach && hn::AllTrue(d, hn::Le(off, hn::Load(d, place.reach_m.data() + i)));
    const auto to_next = hn::Abs(hn::Sub(moved, hn::Load(d, ahead.signal_m + i)));
    near_next = near_next && hn::AllTrue(d, hn::Le(to_next, hn::Set(d, ahead.radius_m)));
  }
  ahead.disturbed |= near_next;
  const auto [x_m, y_m, z_m, zero] = place.position_m;
  state.graph.set_position(slot, x_m, y_m, z_m);
  if (HWY_UNLIKELY(!in_reach)) {
    state.search.move(slot, {x_m, y_m, z_m});
    return;
  }
  CellGrid::Cell& cell = grid.cells()[place.cell];
  cell.x_m[place.lane] = x_m;
  cell.y_m[place.lane] = y_m;
  cell.z_m[place.lane] = z_m;
}

/// The edge of the two winners: made, or made young again.
HWY_INLINE void Join(GrowingState& state, int s1, int s2) {
  Graph::Links& links = state.graph.links(s1);
  const int k = IndexOf(links, s2);
  if (HWY_UNLIKELY(k < 0)) {
    state.counts.edges_dropped += state.graph.join(s1, s2);
    return;
  }
  Graph::Links& others = state.graph.links(s2);
  const std::uint16_t* const wins = state.graph.wins();
  links.born[k] = others.born[IndexOf(others, s1)] =
      static_cast<std::uint16_t>(wins[s1] + wins[s2]);
}

/// Asks for the memory that a signal with these winners will change, while the next search runs.
HWY_INLINE void PrefetchNeighbours(GrowingState& state, int s1) {
  const Graph::Links& links = state.graph.links(s1);
  HWY_UNROLL(8)
  for (int k = 0; k < 8; ++k) {  // more are rare; beyond the degree it is some place or none
    const int j = links.neighbour[k] & Graph::kNodeLimit;
    hwy::Prefetch(state.search.grid().places() + j);
  }
}

HWY_INLINE void PrefetchLinks(GrowingState& state, const Winners& winners) {
  for (const int slot : {winners.first, winners.second}) {
    hwy::Prefetch(state.graph.links(slot).neighbour.data());
    hwy::Prefetch(state.graph.links(slot).born.data());
  }
  hwy::Prefetch(state.search.grid().places() + winners.first);
}

/// What a signal does once its winners are known.
HWY_INLINE void Learn(GrowingState& state, const float* signal_m, const Winners& winners,
                      const Winners& next_winners, Ahead& ahead) {
  const GrowingParams& params = state.params;
  const int s1 = winners.first;
  // The new edge is made after the others aged, so it starts at 0 and cannot be too old below.
  state.graph.age_edges(s1);
  Join(state, s1, winners.second);
  state.error[s1] += state.error_decay.stored(winners.first_m2);
  state.utility[s1] += state.decay_of(s1).stored(winners.second_m2 - winners.first_m2);
  state.extremes.touch_risen(s1, state.error[s1]);

  const Graph::Links& links = state.graph.links(s1);
  const std::uint16_t* const wins = state.graph.wins();
  ahead.disturbed |= s1 == next_winners.first || s1 == next_winners.second ||
                     IndexOf(links, next_winners.first) >= 0 ||
                     IndexOf(links, next_winners.second) >= 0;
  Move(state, s1, signal_m, params.winner_rate, ahead);
  int oldest = 0;
  for (int k = 0; k < links.degree; ++k) {
    const int j = links.neighbour[k];
    Move(state, j, signal_m, params.neighbour_rate, ahead);
    const auto age = static_cast<std::uint16_t>(wins[s1] + wins[j] - links.born[k]);
    oldest = std::max(oldest, static_cast<int>(age));
  }
  if (HWY_UNLIKELY(oldest > params.max_edge_age)) {
    state.remove_old_edges(s1);
    ahead.disturbed = true;
  }

  bool shrink_due = false;
  for (Decay* decay : {&state.error_decay, &state.utility_decay[0], &state.utility_decay[1]}) {
    decay->next_signal();
    shrink_due = shrink_due || decay->shrink_due();
  }
  if (HWY_UNLIKELY(shrink_due)) state.shrink();
}

void Signals(GrowingState& state, std::span<const Signal> signals, Winners* winners) {
  const std::size_t last = signals.size() - 1;
  Ahead searches[2];  // of this signal and of the next, in turns: copies would cost time
  SearchAhead(state, signals[0], searches[0], winners[0]);
  for (std::size_t i = 0; i <= last; ++i) {
    Ahead& now = searches[i % 2];
    Ahead& next = searches[(i + 1) % 2];
    const std::size_t next_i = std::min(i + 1, last);
    PrefetchNeighbours(state, winners[i].first);
    if (i < last) SearchAhead(state, signals[next_i], next, winners[next_i]);
    PrefetchLinks(state, winners[next_i]);
    Learn(state, now.signal_m, winners[i], winners[next_i], next);
    if (HWY_UNLIKELY(next.disturbed) && i < last) {
      SearchAhead(state, signals[next_i], next, winners[next_i]);
    }
  }
  state.counts.signals += static_cast<std::int64_t>(signals.size());
}

}  // namespace HWY_NAMESPACE
}  // namespace ddgng
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ddgng {

HWY_EXPORT(Signals);

void Growing::signals(std::span<const Signal> signals, Winners* winners) {
  if (signals.empty()) return;
  HWY_DYNAMIC_DISPATCH(Signals)(state_, signals, winners);
  state_.search.learn_spacing(graph(), winners[signals.size() - 1],
                              static_cast<int>(signals.size()));
}

}  // namespace ddgng
#endif
