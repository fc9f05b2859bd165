// SPDX-License-Identifier: BSD-3-Clause
#include "ddgng/growing_state.h"

#include <algorithm>

#include "base/check.h"
#include "ddgng/strength.h"

namespace ddgng {

GrowingState::GrowingState(const GrowingParams& growing_params)
    : params(growing_params),
      inside_weight(insertion_weight(growing_params, true)),
      graph(params.max_nodes, params.max_degree),
      search(graph.padded_slots()),
      error(graph.padded_slots()),
      utility(graph.padded_slots()),
      inside(graph.padded_slots()),
      extremes(graph.padded_slots()),
      error_decay(params.error_decay),
      utility_decay{Decay(params.utility_decay_outside), Decay(params.utility_decay_inside)} {
  CHECK(check(params).empty(), "unchecked parameters");
  clear();
}

void GrowingState::clear() {
  graph.clear();
  search.clear();
  std::fill(error.begin(), error.end(), Extremes::kNoError);
  std::fill(utility.begin(), utility.end(), Extremes::kNoUtility);
  std::fill(inside.begin(), inside.end(), std::uint8_t{0});
  error_decay.clear();
  for (Decay& decay : utility_decay) decay.clear();
  num_inside = 0;
  extremes.touch_all();
  counts = {};
}

int GrowingState::place(const Eigen::Vector3f& position_m, float stored_error,
                        float stored_utility) {
  const int slot = graph.add_node(position_m);
  search.add(slot, false, position_m);
  error[slot] = stored_error;
  utility[slot] = stored_utility;
  extremes.touch(slot);
  return slot;
}

void GrowingState::remove(int slot) {
  search.remove(slot);
  if (inside[slot] != 0) --num_inside;
  inside[slot] = 0;
  graph.remove_node(slot);
  error[slot] = Extremes::kNoError;
  utility[slot] = Extremes::kNoUtility;
  extremes.touch(slot);
}

void GrowingState::remove_old_edges(int s1) {
  for (int k = graph.degree(s1) - 1; k >= 0; --k) {  // backwards: the last one fills the gap
    if (graph.age(s1, k) <= params.max_edge_age) continue;
    const int j = graph.neighbours(s1)[k];
    graph.separate(s1, j);
    if (graph.degree(j) > 0) continue;
    remove(j);  // never s1 or s2, which are joined: two nodes always remain
    ++counts.removed_by_age;
  }
}

void GrowingState::shrink() {
  const auto factor = static_cast<float>(Decay::kShrink);
  if (error_decay.shrink_due()) {
    for (int slot = 0; slot < graph.num_slots(); ++slot) {
      if (graph.alive(slot)) error[slot] *= factor;
    }
    error_decay.shrink();
  }
  for (int group = 0; group < 2; ++group) {
    if (!utility_decay[group].shrink_due()) continue;
    for (int slot = 0; slot < graph.num_slots(); ++slot) {
      if (graph.alive(slot) && inside[slot] == group) utility[slot] *= factor;
    }
    utility_decay[group].shrink();
  }
  extremes.touch_all();
}

void GrowingState::set_inside(int slot, bool inside_now) {
  if ((inside[slot] != 0) == inside_now) return;
  const float value_m2 = utility_m2(slot);
  search.remove(slot);
  search.add(slot, inside_now, graph.position_m(slot));
  inside[slot] = inside_now ? 1 : 0;
  utility[slot] = decay_of(slot).stored(value_m2);
  extremes.touch(slot);
  num_inside += inside_now ? 1 : -1;
}

}  // namespace ddgng
