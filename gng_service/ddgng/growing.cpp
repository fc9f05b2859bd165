// SPDX-License-Identifier: BSD-3-Clause
#include "ddgng/growing.h"

#include <algorithm>

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
      extremes_(graph_.padded_slots()),
      error_decay_(params.error_decay),
      utility_decay_{Decay(params.utility_decay_outside), Decay(params.utility_decay_inside)} {
  CHECK(check(params).empty(), "unchecked parameters");
  clear();
}

void Growing::clear() {
  graph_.clear();
  search_.clear();
  std::fill(error_.begin(), error_.end(), Extremes::kNoError);
  std::fill(utility_.begin(), utility_.end(), Extremes::kNoUtility);
  std::fill(inside_.begin(), inside_.end(), std::uint8_t{0});
  error_decay_.clear();
  for (Decay& decay : utility_decay_) decay.clear();
  num_inside_ = 0;
  extremes_.touch_all();
  counts_ = {};
}

// A new node, outside the suspected area. error and utility as stored.
int Growing::place(const Eigen::Vector3f& position_m, float error, float utility) {
  const int slot = graph_.add_node(position_m);
  search_.add(slot, false, position_m);
  error_[slot] = error;
  utility_[slot] = utility;
  extremes_.touch(slot);
  return slot;
}

void Growing::start(const Eigen::Vector3f& h1_m, const Eigen::Vector3f& h2_m) {
  CHECK(graph_.num_nodes() == 0, "started twice");
  for (const Eigen::Vector3f& h_m : {h1_m, h2_m}) place(h_m, 0.0F, 0.0F);
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
  extremes_.touch(s1);
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
    for (int slot = 0; slot < graph_.num_slots(); ++slot) {
      if (graph_.alive(slot)) error_[slot] *= static_cast<float>(Decay::kShrink);
    }
    error_decay_.shrink();
    extremes_.touch_all();
  }
  for (int group = 0; group < 2; ++group) {
    Decay& decay = utility_decay_[group];
    decay.next_signal();
    if (!decay.shrink_due()) continue;
    for (int slot = 0; slot < graph_.num_slots(); ++slot) {
      if (!graph_.alive(slot) || inside_[slot] != group) continue;
      utility_[slot] *= static_cast<float>(Decay::kShrink);
    }
    decay.shrink();
    extremes_.touch_all();
  }
}

float Growing::weighted_error(int slot, Weighting weighting) const {
  const bool weighted = weighting == Weighting::kErrorAndStrength && inside(slot);
  return weighted ? error_[slot] * inside_weight_ : error_[slot];
}

// Among nodes with an edge; nearly always the very largest has one.
int Growing::largest_error(Weighting weighting) {
  const bool weighted = weighting == Weighting::kErrorAndStrength;
  int u = extremes_.largest_error(values(), weighted ? inside_weight_ : 1.0F).slot;
  if (u >= 0 && graph_.alive(u) && graph_.degree(u) > 0) return u;
  u = -1;
  for (int i = 0; i < graph_.num_slots(); ++i) {
    if (graph_.degree(i) == 0) continue;
    if (u < 0 || weighted_error(i, weighting) > weighted_error(u, weighting)) u = i;
  }
  return u;
}

int Growing::insert(Weighting weighting) {
  if (graph_.num_nodes() >= graph_.max_nodes()) return -1;
  const int u = largest_error(weighting);
  if (u < 0) return -1;
  int f = -1;
  for (const int j : graph_.neighbours(u)) {
    const float ahead = f < 0 ? 1.0F : weighted_error(j, weighting) - weighted_error(f, weighting);
    if (ahead > 0.0F || (ahead == 0.0F && j < f)) f = j;
  }

  for (const int parent : {u, f}) {
    error_[parent] *= 1.0F - params_.error_cut;
    utility_[parent] *= 1.0F - params_.error_cut;
    extremes_.touch(parent);
  }
  const int r =
      place(0.5F * (graph_.position_m(u) + graph_.position_m(f)), 0.5F * (error_[u] + error_[f]),
            utility_decay_[0].stored(0.5F * (utility_m2(u) + utility_m2(f))));
  graph_.separate(u, f);
  graph_.join(u, r);
  graph_.join(f, r);
  ++counts_.inserted;
  return r;
}

int Growing::remove_useless() {
  if (graph_.num_nodes() <= params_.min_utility_nodes) return -1;
  // Both groups on the outside's scale.
  const auto inside_scale =
      static_cast<float>(utility_decay_[0].growth() / utility_decay_[1].growth());
  const float largest_error = extremes_.largest_error(values(), 1.0F).value;
  const int l = extremes_.least_utility(values(), inside_scale).slot;
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
  error_[slot] = Extremes::kNoError;
  utility_[slot] = Extremes::kNoUtility;
  extremes_.touch(slot);
}

void Growing::set_inside(int slot, bool inside_now) {
  if (inside(slot) == inside_now) return;
  const float utility = utility_m2(slot);
  search_.remove(slot, !inside_now);
  search_.add(slot, inside_now, graph_.position_m(slot));
  inside_[slot] = inside_now ? 1 : 0;
  utility_[slot] = decay_of(slot).stored(utility);
  extremes_.touch(slot);
  num_inside_ += inside_now ? 1 : -1;
}

float Growing::strength(int slot) const {
  return ddgng::strength(params_, inside(slot));
}

}  // namespace ddgng
