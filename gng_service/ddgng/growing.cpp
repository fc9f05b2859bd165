// SPDX-License-Identifier: BSD-3-Clause
#include "ddgng/growing.h"

#include <algorithm>
#include <limits>

#include "base/check.h"
#include "ddgng/strength.h"

namespace ddgng {

Growing::Growing(const GrowingParams& params)
    : params_(params),
      inside_weight_(insertion_weight(params, true)),
      graph_(params.max_nodes, params.max_degree),
      search_(graph_.padded_slots()),
      error_(graph_.padded_slots()),
      utility_(graph_.padded_slots()),
      inside_(graph_.padded_slots()),
      error_decay_(params.error_decay),
      utility_decay_{Decay(params.utility_decay_outside), Decay(params.utility_decay_inside)} {
  CHECK(check(params).empty(), "unchecked parameters");
  clear();
}

void Growing::clear() {
  graph_.clear();
  search_.clear();
  std::fill(error_.begin(), error_.end(), 0.0F);
  std::fill(utility_.begin(), utility_.end(), 0.0F);
  std::fill(inside_.begin(), inside_.end(), std::uint8_t{0});
  error_decay_.clear();
  for (Decay& decay : utility_decay_) decay.clear();
  num_inside_ = 0;
  counts_ = {};
}

void Growing::start(const Eigen::Vector3f& h1_m, const Eigen::Vector3f& h2_m) {
  CHECK(graph_.num_nodes() == 0, "started twice");
  for (const Eigen::Vector3f& h_m : {h1_m, h2_m}) search_.add(graph_.add_node(h_m), false, h_m);
}

Winners Growing::signal(const Eigen::Vector3f& signal_m) {
  ++counts_.signals;
  const Winners winners = search_.nearest_two(graph_, signal_m);
  const int s1 = winners.first;
  search_.learn_spacing(graph_, inside_.data(), winners);
  // The new edge is made after the others aged, so it starts at 0 and cannot be too old below.
  graph_.age_edges(s1);
  counts_.edges_dropped += graph_.join(s1, winners.second);
  error_[s1] += error_decay_.stored(winners.first_m2);
  utility_[s1] += decay_of(s1).stored(winners.second_m2 - winners.first_m2);
  move_towards(s1, signal_m, params_.winner_rate);
  for (const int j : graph_.neighbours(s1)) move_towards(j, signal_m, params_.neighbour_rate);
  remove_old_edges(s1);
  fade();
  return winners;
}

void Growing::move_towards(int slot, const Eigen::Vector3f& signal_m, float rate) {
  graph_.move_towards(slot, signal_m, rate);
  search_.move(slot, inside(slot), graph_.position_m(slot));
}

void Growing::remove_old_edges(int s1) {
  for (int k = graph_.degree(s1) - 1; k >= 0; --k) {  // backwards: the last one fills the gap
    if (graph_.age(s1, k) <= params_.max_edge_age) continue;
    const int j = graph_.neighbours(s1)[k];
    graph_.separate(s1, j);
    if (graph_.degree(j) > 0) continue;
    remove(j);  // never s1 or s2, which are joined: two nodes always remain
    ++counts_.removed_by_age;
  }
}

void Growing::fade() {
  error_decay_.next_signal();
  if (error_decay_.shrink_due()) {
    for (float& error : error_) error *= static_cast<float>(Decay::kShrink);
    error_decay_.shrink();
  }
  for (int group = 0; group < 2; ++group) {
    Decay& decay = utility_decay_[group];
    decay.next_signal();
    if (!decay.shrink_due()) continue;
    for (int slot = 0; slot < graph_.num_slots(); ++slot) {
      if (inside_[slot] == group) utility_[slot] *= static_cast<float>(Decay::kShrink);
    }
    decay.shrink();
  }
}

float Growing::weighted_error(int slot, Weighting weighting) const {
  const bool weighted = weighting == Weighting::kErrorAndStrength && inside(slot);
  return weighted ? error_[slot] * inside_weight_ : error_[slot];
}

int Growing::insert(Weighting weighting) {
  if (graph_.num_nodes() >= graph_.max_nodes()) return -1;
  int u = -1;
  for (int i = 0; i < graph_.num_slots(); ++i) {
    if (graph_.degree(i) == 0) continue;
    if (u < 0 || weighted_error(i, weighting) > weighted_error(u, weighting)) u = i;
  }
  if (u < 0) return -1;
  int f = -1;
  for (const int j : graph_.neighbours(u)) {
    const float ahead = f < 0 ? 1.0F : weighted_error(j, weighting) - weighted_error(f, weighting);
    if (ahead > 0.0F || (ahead == 0.0F && j < f)) f = j;
  }

  const int r = graph_.add_node(0.5F * (graph_.position_m(u) + graph_.position_m(f)));
  graph_.separate(u, f);
  graph_.join(u, r);
  graph_.join(f, r);
  for (const int parent : {u, f}) {
    error_[parent] *= 1.0F - params_.error_cut;
    utility_[parent] *= 1.0F - params_.error_cut;
  }
  error_[r] = 0.5F * (error_[u] + error_[f]);
  search_.add(r, false, graph_.position_m(r));
  utility_[r] = utility_decay_[0].stored(0.5F * (utility_m2(u) + utility_m2(f)));
  ++counts_.inserted;
  return r;
}

int Growing::remove_useless() {
  if (graph_.num_nodes() <= params_.min_utility_nodes) return -1;
  // Both groups on the outside's scale.
  const auto inside_scale =
      static_cast<float>(utility_decay_[0].growth() / utility_decay_[1].growth());
  float largest_error = -1.0F;
  float least_utility = std::numeric_limits<float>::max();
  int l = -1;
  for (int i = 0; i < graph_.num_slots(); ++i) {
    if (!graph_.alive(i)) continue;
    largest_error = std::max(largest_error, error_[i]);
    const float utility = inside(i) ? utility_[i] * inside_scale : utility_[i];
    if (utility < least_utility) {
      least_utility = utility;
      l = i;
    }
  }
  if (error_decay_.value(largest_error) <= params_.utility_threshold * utility_m2(l)) return -1;
  remove(l);
  ++counts_.removed_by_utility;
  return l;
}

void Growing::remove(int slot) {
  search_.remove(slot, inside(slot));
  if (inside(slot)) --num_inside_;
  inside_[slot] = 0;
  graph_.remove_node(slot);
  error_[slot] = 0.0F;
  utility_[slot] = 0.0F;
}

void Growing::set_inside(int slot, bool inside_now) {
  if (inside(slot) == inside_now) return;
  const float utility = utility_m2(slot);
  search_.remove(slot, !inside_now);
  search_.add(slot, inside_now, graph_.position_m(slot));
  inside_[slot] = inside_now ? 1 : 0;
  utility_[slot] = decay_of(slot).stored(utility);
  num_inside_ += inside_now ? 1 : -1;
}

float Growing::strength(int slot) const {
  return ddgng::strength(params_, inside(slot));
}

}  // namespace ddgng
