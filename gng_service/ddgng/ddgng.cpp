// SPDX-License-Identifier: BSD-3-Clause
#include "ddgng/ddgng.h"

#include <algorithm>
#include <array>

#include "base/check.h"

namespace ddgng {

std::string check(const DdgngParams& params) {
  if (std::string broken = check(params.growing); !broken.empty()) return broken;
  if (std::string broken = check(params.structure); !broken.empty()) return broken;
  return params.max_points >= 1 ? "" : "max_points must be >= 1";
}

DynamicDensityGng::DynamicDensityGng(const DdgngParams& params)
    : params_(params),
      sampler_(params.growing),
      growing_(params.growing),
      moments_(params.growing, growing_.graph().padded_slots()),
      snapshot_(growing_.graph()),
      structure_(params.structure, growing_.graph().max_nodes(), growing_.graph().max_edges()),
      attention_(params.structure, static_cast<std::size_t>(params.max_points)) {
  CHECK(check(params).empty(), "unchecked parameters");
  snapshot_.reserve(topology_);
}

void DynamicDensityGng::reset() {
  *this = DynamicDensityGng(params_);
}

// Algorithm 1.
const Topology& DynamicDensityGng::update(const CloudView& cloud) {
  CHECK(cloud.size() <= static_cast<std::size_t>(params_.max_points), "cloud above max_points");
  sampler_.start_frame(cloud.sequence);
  moments_.forget();
  if (!growing_.started()) {
    if (start(cloud)) boot(cloud);
  }
  if (growing_.started()) {
    const std::span<const std::uint32_t> suspected_points = attend(cloud);
    set_strengths();
    const bool density = params_.growing.attention_signals > 0;
    learn(sampler_.draw(cloud, suspected_points),
          density ? params_.growing.max_plane_nodes : params_.growing.max_nodes);
  }
  build_topology(cloud);
  return topology_;
}

// Lines 1-2: two random points of the first cloud that has two.
bool DynamicDensityGng::start(const CloudView& cloud) {
  if (cloud.size() < 2) return false;
  const std::span<const Signal> first_two = sampler_.draw_uniform(cloud, 2);
  if (first_two.size() < 2) return false;
  growing_.start(first_two[0].position_m, first_two[1].position_m);
  return true;
}

// PAPER: the paper starts without; then a whole frame passes before anything is suspected;
// docs/EQUATIONS.md
void DynamicDensityGng::boot(const CloudView& cloud) {
  if (params_.growing.boot_signals == 0 || params_.growing.attention_signals == 0) return;
  learn(sampler_.draw_uniform(cloud, params_.growing.boot_signals), params_.growing.max_boot_nodes);
  build_topology(cloud);
}

// What the previous frame suspected decides where this one looks.
std::span<const std::uint32_t> DynamicDensityGng::attend(const CloudView& cloud) {
  if (params_.growing.attention_signals == 0) return {};
  attention_.set_regions(topology_, cloud);
  const std::span<const std::uint32_t> points = attention_.select(cloud);
  num_suspected_points_ = points.size();
  steered_ = !points.empty();
  return points;
}

// Lines 3-20 for all signals of a frame, in runs between the checks that may change the nodes.
void DynamicDensityGng::learn(std::span<const Signal> signals, int max_plane_nodes) {
  const int utility_interval = params_.growing.utility_interval;
  const int insertion_interval = params_.growing.insertion_interval;
  const auto num_signals = static_cast<int>(signals.size());
  std::array<Winners, 64> winners;
  for (int begin = 0, end = 0; begin < num_signals; begin = end) {
    end = std::min({num_signals, begin + static_cast<int>(winners.size()),
                    (begin / utility_interval + 1) * utility_interval,
                    (begin / insertion_interval + 1) * insertion_interval});
    growing_.signals(signals.subspan(begin), end - begin, winners.data());
    moments_.add(signals.subspan(begin, end - begin), winners.data());
    if (end % utility_interval == 0) growing_.remove_useless();
    if (end % insertion_interval == 0) insertion_round(end / insertion_interval, max_plane_nodes);
  }
}

// PAPER: one round per frame; then a ladder gets no node in its first seconds; docs/EQUATIONS.md
void DynamicDensityGng::insertion_round(int round, int max_plane_nodes) {
  const auto room = [&] {
    return growing_.graph().num_nodes() - growing_.num_inside() < max_plane_nodes;
  };
  const bool plain_too = round % params_.growing.plain_insertion_every == 0;
  if (plain_too && room()) insert(Growing::Weighting::kError);
  // With nothing suspected, all strengths are equal and this is a plain insertion too.
  if (steered_ || room()) insert(Growing::Weighting::kErrorAndStrength);
}

void DynamicDensityGng::insert(Growing::Weighting weighting) {
  const int slot = growing_.insert(weighting);
  if (slot < 0) return;
  growing_.set_inside(slot, suspected(slot));
  moments_.clear(slot);
}

bool DynamicDensityGng::suspected(int slot) const {
  return steered_ && attention_.contains(growing_.graph().position_m(slot));
}

// Algorithm 2 for every node.
void DynamicDensityGng::set_strengths() {
  for (int slot = 0; slot < growing_.graph().num_slots(); ++slot) {
    if (growing_.graph().alive(slot)) growing_.set_inside(slot, suspected(slot));
  }
}

void DynamicDensityGng::build_topology(const CloudView& cloud) {
  snapshot_.take(growing_, moments_, topology_);
  structure_.build(cloud, topology_);
}

}  // namespace ddgng
