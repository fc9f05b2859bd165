// SPDX-License-Identifier: BSD-3-Clause
#include "ddgng/growing.h"

#include "base/check.h"
#include "ddgng/strength.h"

namespace ddgng {

void Growing::start(const Eigen::Vector3f& h1_m, const Eigen::Vector3f& h2_m) {
  CHECK(graph().num_nodes() == 0, "started twice");
  for (const Eigen::Vector3f& h_m : {h1_m, h2_m}) state_.place(h_m, 0.0F, 0.0F);
}

float Growing::weighted_error(int slot, Weighting weighting) const {
  const bool weighted = weighting == Weighting::kErrorAndStrength && inside(slot);
  return weighted ? state_.error[slot] * state_.inside_weight : state_.error[slot];
}

// Among nodes with an edge; nearly always the very largest has one.
int Growing::largest_error(Weighting weighting) {
  const bool weighted = weighting == Weighting::kErrorAndStrength;
  int u = state_.extremes.largest_error(values(), weighted ? state_.inside_weight : 1.0F).slot;
  if (u >= 0 && state_.graph.alive(u) && state_.graph.degree(u) > 0) return u;
  u = -1;
  for (int i = 0; i < state_.graph.num_slots(); ++i) {
    if (state_.graph.degree(i) == 0) continue;
    if (u < 0 || weighted_error(i, weighting) > weighted_error(u, weighting)) u = i;
  }
  return u;
}

int Growing::insert(Weighting weighting) {
  if (state_.graph.num_nodes() >= state_.graph.max_nodes()) return -1;
  const int u = largest_error(weighting);
  if (u < 0) return -1;
  int f = -1;
  for (const int j : state_.graph.neighbours(u)) {
    const float ahead = f < 0 ? 1.0F : weighted_error(j, weighting) - weighted_error(f, weighting);
    if (ahead > 0.0F || (ahead == 0.0F && j < f)) f = j;
  }

  for (const int parent : {u, f}) {
    state_.error[parent] *= 1.0F - state_.params.error_cut;
    state_.utility[parent] *= 1.0F - state_.params.error_cut;
    state_.extremes.touch(parent);
  }
  const int r =
      state_.place(0.5F * (state_.graph.position_m(u) + state_.graph.position_m(f)),
                   0.5F * (state_.error[u] + state_.error[f]),
                   state_.utility_decay[0].stored(0.5F * (utility_m2(u) + utility_m2(f))));
  state_.graph.separate(u, f);
  state_.graph.join(u, r);
  state_.graph.join(f, r);
  ++state_.counts.inserted;
  return r;
}

int Growing::remove_useless() {
  if (state_.graph.num_nodes() <= state_.params.min_utility_nodes) return -1;
  if (state_.extremes.bounds_hold() && surely_all_useful()) return -1;
  state_.extremes.find_bounds(values());
  if (surely_all_useful()) return -1;
  // Both groups on the outside's scale.
  const auto inside_scale =
      static_cast<float>(state_.utility_decay[0].growth() / state_.utility_decay[1].growth());
  const float largest_error = state_.extremes.largest_error(values(), 1.0F).value;
  const int l = state_.extremes.least_utility(values(), inside_scale).slot;
  if (useful(largest_error, utility_m2(l))) return -1;
  state_.remove(l);
  ++state_.counts.removed_by_utility;
  return l;
}

bool Growing::useful(float stored_error, float utility_m2) const {
  return state_.error_decay.value(stored_error) <= state_.params.utility_threshold * utility_m2;
}

bool Growing::surely_all_useful() const {
  const Extremes::Bounds bounds = state_.extremes.bounds();
  return useful(bounds.error, state_.utility_decay[0].value(bounds.utility[0])) &&
         useful(bounds.error, state_.utility_decay[1].value(bounds.utility[1]));
}

float Growing::strength(int slot) const {
  return ddgng::strength(state_.params, inside(slot));
}

}  // namespace ddgng
