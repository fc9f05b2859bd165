// SPDX-License-Identifier: BSD-3-Clause
#include "ddgng/params.h"

#include <array>

#include "ddgng/graph.h"

namespace ddgng {
namespace {

struct Relation {
  bool holds;
  const char* words;
};

template <typename T>
bool in(T value, T low, T high) {  // false for NaN
  return value >= low && value <= high;
}

}  // namespace

GrowingParams paper_params() {
  GrowingParams p;
  p.uniform_signals = 250;
  p.attention_signals = 250;
  p.insertion_interval = 500;
  p.plain_insertion_every = 1;
  p.max_plane_nodes = p.max_nodes;
  p.boot_signals = 0;
  p.error_decay = 0.005F;
  p.utility_decay_outside = 9.5e-4F;
  p.utility_decay_inside = 9.5e-4F / p.strength_inside;
  return p;
}

std::string check(const GrowingParams& p) {
  const std::array<Relation, 22> relations{{
      {in(p.uniform_signals, 0, 1000000), "uniform_signals must be 0..1000000"},
      {in(p.attention_signals, 0, 1000000), "attention_signals must be 0..1000000"},
      {p.insertion_interval >= 1, "insertion_interval must be >= 1"},
      {p.plain_insertion_every >= 1, "plain_insertion_every must be >= 1"},
      {in(p.max_nodes, 2, Graph::kNodeLimit), "max_nodes must be 2..32767"},
      {p.max_plane_nodes >= 2, "max_plane_nodes must be >= 2"},
      {in(p.max_degree, 2, Graph::kDegreeLimit), "max_degree must be 2..31"},
      {in(p.boot_signals, 0, 1000000), "boot_signals must be 0..1000000"},
      {in(p.max_boot_nodes, 2, p.max_nodes), "max_boot_nodes must be 2..max_nodes"},
      {in(p.winner_rate, 0.0F, 1.0F), "winner_rate must be 0..1"},
      {in(p.neighbour_rate, 0.0F, p.winner_rate), "neighbour_rate must be 0..winner_rate"},
      {in(p.max_edge_age, 1, Graph::kAgeLimit), "max_edge_age must be 1..30000"},
      {in(p.error_cut, 0.0F, 1.0F), "error_cut must be 0..1"},
      {in(p.error_decay, 0.0F, 0.1F), "error_decay must be 0..0.1"},
      {in(p.utility_decay_outside, 0.0F, 0.1F) && in(p.utility_decay_inside, 0.0F, 0.1F),
       "utility_decay_outside and utility_decay_inside must be 0..0.1"},
      {in(p.utility_threshold, 1e-6F, 1e12F), "utility_threshold must be 1e-6..1e12"},
      {p.utility_interval >= 1 && p.min_utility_nodes >= 2,
       "utility_interval must be >= 1 and min_utility_nodes >= 2"},
      {in(p.strength_outside, 1e-3F, 1e3F) && in(p.strength_inside, p.strength_outside, 1e3F),
       "strength_outside must be 0.001..1000 and strength_inside strength_outside..1000"},
      {in(p.strength_exponent, 0, 8), "strength_exponent must be 0..8"},
      {in(p.moment_gate_m, 1e-6F, 100.0F), "moment_gate_m must be 1e-6..100"},
      {in(p.moment_forget, 0.0F, 1.0F), "moment_forget must be 0..1"},
      {in(p.min_moment_weight, 1e-6F, 1e6F), "min_moment_weight must be 1e-6..1e6"},
  }};
  for (const Relation& relation : relations) {
    if (!relation.holds) return relation.words;
  }
  return "";
}

}  // namespace ddgng
