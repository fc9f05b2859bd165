// SPDX-License-Identifier: BSD-3-Clause
// What signals do to the graph: the inner loop of everything. Compiled once per instruction set by
// Highway, with the winner search in it; the best one of the machine is chosen at run time.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/check.h"
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

HWY_INLINE void ListCellsOf(const GrowingState& state, const Signal& signal, Ahead& ahead) {
  // As a whole: a vector read from where single elements were just written would wait for them.
  static_assert(offsetof(Signal, position_m) == 0 && sizeof(Signal) == sizeof(Graph::Position));
  const hn::CappedTag<float, 4> d;
  for (int i = 0; i < 4; i += static_cast<int>(hn::Lanes(d))) {
    const auto* const from = reinterpret_cast<const float*>(&signal) + i;
    const auto coordinates = hn::FirstN(d, static_cast<std::size_t>(std::max(0, 3 - i)));
    hn::Store(hn::IfThenElseZero(coordinates, hn::LoadU(d, from)), d,
              &ahead.query.signal_m.x_m + i);
  }
  ahead.found = false;
  ListCells(state.search, ahead.query);
}

HWY_INLINE void Find(GrowingState& state, Ahead& ahead) {
  NearestTwo(state.search, state.graph, ahead.query);
  ahead.found = true;
  ahead.changes = state.search.changes();
}

/// Of the nodes that were moved, the largest: distance from the signal on each axis before;
/// distance beyond their reach now; age of the winner's edge to them.
struct Moves {
  HWY_ALIGN float off_m[4] = {};
  HWY_ALIGN float beyond_m[4] = {};
  int oldest_age = 0;
};

/// Moves the winner and its neighbours a part of the way to the signal. The ages are looked at on
/// the way: a loop of their own would end as unpredictably as this one.
HWY_INLINE Moves MoveAll(GrowingState& state, const Graph::Links& links, const Query& query) {
  const int s1 = query.winners.first;
  CellGrid::Place* const places = state.search.grid().places();
  CellGrid::Cell* const cells = state.search.grid().cells();
  Graph::Position* const positions = state.graph.positions();
  const int degree = links.degree;
  const hn::CappedTag<float, 4> d;
  Moves moves;
  for (int i = 0; i < 4; i += static_cast<int>(hn::Lanes(d))) {  // once, but for scalars
    const auto target = hn::Load(d, &query.signal_m.x_m + i);
    auto rate = hn::Set(d, state.params.winner_rate);
    auto off = hn::Zero(d);
    auto beyond = hn::Zero(d);
    for (int k = 0, j = s1;; j = links.neighbour[k++]) {
      float* const position = &positions[j].x_m + i;
      const CellGrid::Place& place = places[j];
      const auto old = hn::Load(d, position);
      const auto way = hn::Sub(target, old);
      const auto moved = hn::Add(old, hn::Mul(rate, way));
      hn::Store(moved, d, position);
      off = hn::Max(off, hn::Abs(way));
      const auto from_center = hn::Abs(hn::Sub(moved, hn::Load(d, place.center_m.data() + i)));
      beyond = hn::Max(beyond, hn::Sub(from_center, hn::Load(d, place.reach_m.data() + i)));
      const auto [x_m, y_m, z_m, zero] = positions[j];
      CellGrid::Cell& cell = cells[place.cell];
      cell.x_m[place.lane] = x_m;
      cell.y_m[place.lane] = y_m;
      cell.z_m[place.lane] = z_m;
      if (k == degree) break;
      rate = hn::Set(d, state.params.neighbour_rate);
      moves.oldest_age = std::max(moves.oldest_age, state.graph.age(s1, k));
    }
    hn::Store(off, d, moves.off_m + i);
    hn::Store(beyond, d, moves.beyond_m + i);
  }
  return moves;
}

/// Whether a node that has moved may be, or have been, one of the two winners that the search for
/// the next signal found before. Two boxes: round this signal, the moved nodes; round the next, all
/// that is no farther than its second winner.
HWY_INLINE bool MayDisturb(const Query& query, const Moves& moves, const Query& next) {
  constexpr float kMargin = 1.0001F;  // more than rounding
  const float radius_m = std::sqrt(next.winners.second_m2);
  const hn::CappedTag<float, 4> d;
  bool overlap = true;
  for (int i = 0; i < 4; i += static_cast<int>(hn::Lanes(d))) {
    const auto apart =
        hn::Abs(hn::Sub(hn::Load(d, &next.signal_m.x_m + i), hn::Load(d, &query.signal_m.x_m + i)));
    const auto sum = hn::Add(hn::Load(d, moves.off_m + i), hn::Set(d, radius_m));
    overlap = overlap && hn::AllTrue(d, hn::Le(apart, hn::Mul(sum, hn::Set(d, kMargin))));
  }
  return overlap;
}

HWY_INLINE bool IsBeyond(const float* beyond_m) {
  return std::max(std::max(beyond_m[0], beyond_m[1]), beyond_m[2]) > 0.0F;
}

/// Tells the search of those that may have left their cells.
inline HWY_NOINLINE void TellMoves(GrowingState& state, int s1) {
  state.search.move(s1, state.graph.position_m(s1));
  for (const int j : state.graph.neighbours(s1)) state.search.move(j, state.graph.position_m(j));
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

/// Asks for memory that a signal with these winners will change.
HWY_INLINE void PrefetchLinks(const GrowingState& state, const Winners& winners) {
  for (const int slot : {winners.first, winners.second}) {
    hwy::Prefetch(state.graph.links(slot).neighbour.data());
    hwy::Prefetch(state.graph.links(slot).born.data());
  }
  hwy::Prefetch(state.search.grid().places() + winners.first);
}

/// What a signal does to the graph but for the moves and to edges that are too old.
HWY_INLINE void Learn(GrowingState& state, const Winners& winners) {
  const int s1 = winners.first;
  // The new edge is made after the others aged, so it starts at 0 and cannot be too old.
  state.graph.age_edges(s1);
  Join(state, s1, winners.second);
  state.error[s1] += state.error_decay.stored(winners.first_m2);
  state.utility[s1] += state.decay_of(s1).stored(winners.second_m2 - winners.first_m2);
  state.extremes.touch_risen(s1, state.error[s1]);
  state.error_decay.next_signal();
  for (Decay& decay : state.utility_decay) decay.next_signal();
}

/// One signal; the search for the next has run already and is repeated where this one disturbs it.
HWY_INLINE void LearnAndMove(GrowingState& state, const Query& query, Ahead& next) {
  const int s1 = query.winners.first;
  Learn(state, query.winners);
  const Moves moves = MoveAll(state, state.graph.links(s1), query);
  if (HWY_UNLIKELY(IsBeyond(moves.beyond_m))) TellMoves(state, s1);
  if (HWY_UNLIKELY(moves.oldest_age > state.params.max_edge_age)) state.remove_old_edges(s1);
  if (!next.found) return;
  if (HWY_UNLIKELY(MayDisturb(query, moves, next.query)) ||
      HWY_UNLIKELY(next.changes != state.search.changes())) {
    Find(state, next);
  }
}

void Signals(GrowingState& state, std::span<const Signal> signals, std::size_t num,
             Winners* winners) {
  const auto ahead = [&](std::size_t i) -> Ahead& {
    return state.ahead[(state.turn + i) % state.ahead.size()];
  };
  Ahead& first = ahead(0);
  const bool is_found =
      first.found && first.changes == state.search.changes() && first.is_of(signals[0].position_m);
  if (!is_found) {
    ListCellsOf(state, signals[0], first);
    Find(state, first);
  }
  if (signals.size() > 1 && !ahead(1).is_of(signals[1].position_m)) {
    ListCellsOf(state, signals[1], ahead(1));
  }
  for (std::size_t i = 0; i < num; ++i) {
    Ahead& now = ahead(i);
    Ahead& next = ahead(i + 1);
    next.found = false;
    if (i + 2 < signals.size()) ListCellsOf(state, signals[i + 2], ahead(i + 2));
    if (i + 1 < signals.size()) {
      Find(state, next);
      PrefetchLinks(state, next.query.winners);
    }
    LearnAndMove(state, now.query, next);
    winners[i] = now.query.winners;
    now.found = false;
    if (HWY_UNLIKELY(state.shrink_due())) state.shrink();
  }
  state.turn += static_cast<std::uint32_t>(num);
  state.counts.signals += static_cast<std::int64_t>(num);
}

/// The same without cells.
void SignalsLinearly(GrowingState& state, std::span<const Signal> signals, std::size_t num,
                     Winners* winners) {
  for (std::size_t i = 0; i < num; ++i) {
    const Eigen::Vector3f& signal_m = signals[i].position_m;
    winners[i] = nearest_two_linear(state.graph, signal_m);
    const int s1 = winners[i].first;
    Learn(state, winners[i]);
    state.graph.move_towards(s1, signal_m, state.params.winner_rate);
    for (const int j : state.graph.neighbours(s1)) {
      state.graph.move_towards(j, signal_m, state.params.neighbour_rate);
    }
    state.remove_old_edges(s1);
    if (HWY_UNLIKELY(state.shrink_due())) state.shrink();
  }
  state.counts.signals += static_cast<std::int64_t>(num);
}

}  // namespace HWY_NAMESPACE
}  // namespace ddgng
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ddgng {

HWY_EXPORT(Signals);
HWY_EXPORT(SignalsLinearly);

void Growing::signals(std::span<const Signal> signals, std::size_t num, Winners* winners) {
  if (num == 0) return;
  CHECK(num <= signals.size(), "more signals than given");
  if (state_.search.linear_only()) {
    HWY_DYNAMIC_DISPATCH(SignalsLinearly)(state_, signals, num, winners);
    return;
  }
  HWY_DYNAMIC_DISPATCH(Signals)(state_, signals, num, winners);
  state_.search.learn_spacing(graph(), winners[num - 1]);
}

}  // namespace ddgng
#endif
