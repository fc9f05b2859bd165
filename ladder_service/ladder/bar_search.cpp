// SPDX-License-Identifier: BSD-3-Clause
#include "ladder/bar_search.h"

#include <algorithm>
#include <cmath>

#include "ladder/flank_test.h"

namespace ladder {
namespace {

// Members of all bars together: a node is a member of few.
constexpr int kMembersPerNode = 8;

void turn_right(const Eigen::Vector3d& body_m, Bar& bar) {
  const Eigen::Vector3d ahead = level_direction(body_m, bar.axis.origin_m);
  const Eigen::Vector3d right = ahead.cross(Eigen::Vector3d::UnitZ());
  if (bar.axis.direction.dot(right) >= 0.0) return;
  bar.axis.direction = -bar.axis.direction;
  std::swap(bar.from_m, bar.to_m);
  bar.from_m = -bar.from_m;
  bar.to_m = -bar.to_m;
}

}  // namespace

BarSearch::BarSearch(const LadderParams& params) : params_(params), growth_(params) {
  set_.rungs.reserve(2 * params.max_bars);
  set_.rails.reserve(params.max_bars);
  set_.members.reserve(static_cast<std::size_t>(kMembersPerNode) * params.max_nodes);
  seeds_.reserve(params.max_nodes);
  in_rung_.reserve(params.max_nodes);
  in_rail_.reserve(params.max_nodes);
  joined_.reserve(2 * params.max_nodes);
}

const BarSet& BarSearch::search(const BarNodes& nodes, const Eigen::Vector3d& body_m) {
  set_.rungs.clear();
  set_.rails.clear();
  set_.members.clear();
  in_rung_.assign(nodes.size(), 0);
  in_rail_.assign(nodes.size(), 0);
  grow_narrow(nodes);
  drop_flanked(nodes, 0);
  const std::size_t num_narrow = set_.rungs.size();
  grow_wide(nodes);
  drop_flanked(nodes, num_narrow);
  drop_duplicates();
  merge_pieces(nodes);
  merge_rails();
  for (Bar& bar : set_.rungs) turn_right(body_m, bar);
  for (Bar& rail : set_.rails) {
    if (rail.axis.direction.z() >= 0.0) continue;
    rail.axis.direction = -rail.axis.direction;
    std::swap(rail.from_m, rail.to_m);
    rail.from_m = -rail.from_m;
    rail.to_m = -rail.to_m;
  }
  return set_;
}

bool BarSearch::is_long_enough(const Bar& bar, bool upright) const {
  const BarParams& p = params_.bar;
  const double dz = std::abs(bar.axis.direction.z());
  if (upright ? dz < p.upright_min_dz : dz >= p.level_max_dz) return false;
  if (bar.length_m() < (upright ? p.min_rail_length_m : p.min_rung_length_m)) return false;
  if (bar.num_members < (upright ? p.min_rail_nodes : p.min_rung_nodes)) return false;
  if (bar.sum.weight < p.min_weight) return false;
  return bar.spread.is_linear(upright ? p.rail_linearity : p.rung_linearity);
}

void BarSearch::grow_narrow(const BarNodes& nodes) {
  const BarParams& p = params_.bar;
  find_seeds(nodes, p, {p.narrow_neighborhood_m, true}, in_rung_, seeds_);
  for (const Seed& seed : seeds_) {
    std::vector<std::uint8_t>& taken = seed.upright ? in_rail_ : in_rung_;
    std::vector<Bar>& bars = seed.upright ? set_.rails : set_.rungs;
    if (taken[seed.node] || static_cast<int>(bars.size()) >= params_.max_bars) continue;
    const std::size_t num_members = set_.members.size();
    Bar bar;
    if (!growth_.grow(nodes, seed, p.narrow_half_height_m, set_, bar)) continue;
    if (!is_long_enough(bar, seed.upright)) {
      set_.members.resize(num_members);
      continue;
    }
    for (const int k : set_.members_of(bar)) taken[k] = 1;
    bars.push_back(bar);
  }
}

void BarSearch::grow_wide(const BarNodes& nodes) {
  const BarParams& p = params_.bar;
  std::fill(in_rung_.begin(), in_rung_.end(), std::uint8_t{0});
  for (const Bar& bar : set_.rungs) {
    if (bar.doubtful) continue;
    for (const int k : set_.members_of(bar)) in_rung_[k] = 1;
  }
  for (const Bar& rail : set_.rails) {
    for (const int k : set_.members_of(rail)) in_rung_[k] = 1;
  }
  find_seeds(nodes, p, {p.wide_neighborhood_m, false}, in_rung_, seeds_);
  const std::size_t max_rungs = set_.rungs.size() + params_.max_bars;
  for (const Seed& seed : seeds_) {
    if (in_rung_[seed.node] || set_.rungs.size() >= max_rungs) continue;
    const std::size_t num_members = set_.members.size();
    Bar bar;
    if (!growth_.grow(nodes, seed, p.wide_half_height_m, set_, bar)) continue;
    if (!is_long_enough(bar, false)) {
      set_.members.resize(num_members);
      continue;
    }
    bar.wide = true;
    for (const int k : set_.members_of(bar)) in_rung_[k] = 1;
    set_.rungs.push_back(bar);
  }
}

void BarSearch::drop_flanked(const BarNodes& nodes, std::size_t first) {
  std::size_t kept = first;
  for (std::size_t i = first; i < set_.rungs.size(); ++i) {
    Bar bar = set_.rungs[i];
    const Flanks flanks = measure_flanks(nodes, bar, params_.bar);
    if (flanks.larger() > params_.bar.flank_max * flanks.own) continue;
    bar.doubtful = !bar.wide && flanks.twice > params_.bar.wide_gain * flanks.own;
    set_.rungs[kept++] = bar;
  }
  set_.rungs.resize(kept);
}

void BarSearch::drop_duplicates() {
  // Sound narrow bars first; of a doubtful narrow one and a wide one the better supported wins.
  std::sort(set_.rungs.begin(), set_.rungs.end(), [](const Bar& a, const Bar& b) {
    const bool sound_a = !a.wide && !a.doubtful;
    const bool sound_b = !b.wide && !b.doubtful;
    if (sound_a != sound_b) return sound_a;
    if (a.support() != b.support()) return a.support() > b.support();
    return a.first_member < b.first_member;
  });
  std::fill(in_rung_.begin(), in_rung_.end(), std::uint8_t{0});
  std::size_t kept = 0;
  for (std::size_t i = 0; i < set_.rungs.size(); ++i) {
    const Bar bar = set_.rungs[i];
    int num_shared = 0;
    for (const int k : set_.members_of(bar)) num_shared += in_rung_[k];
    if (num_shared > params_.bar.max_shared * bar.num_members) continue;
    for (const int k : set_.members_of(bar)) in_rung_[k] = 1;
    set_.rungs[kept++] = bar;
  }
  set_.rungs.resize(std::min<std::size_t>(kept, params_.max_bars));
}

bool BarSearch::are_pieces(const Bar& a, const Bar& b) const {
  const BarParams& p = params_.bar;
  if (a.wide != b.wide) return false;
  if (std::abs(a.axis.direction.dot(b.axis.direction)) <= p.merge_min_cos) return false;
  if (a.axis.distance(b.axis.origin_m) >= p.merge_offset_m) return false;
  const double between_m = std::abs(a.axis.along(b.axis.origin_m));
  const double gap_m = between_m - 0.5 * (a.length_m() + b.length_m());
  return gap_m < p.merge_gap_m && gap_m > -p.merge_overlap_m;
}

void BarSearch::join(const BarNodes& nodes, Bar& a, const Bar& b) {
  joined_.assign(set_.members_of(a).begin(), set_.members_of(a).end());
  joined_.insert(joined_.end(), set_.members_of(b).begin(), set_.members_of(b).end());
  std::sort(joined_.begin(), joined_.end());
  joined_.erase(std::unique(joined_.begin(), joined_.end()), joined_.end());
  if (set_.members.size() + joined_.size() > set_.members.capacity()) return;
  a.first_member = static_cast<int>(set_.members.size());
  a.num_members = static_cast<int>(joined_.size());
  set_.members.insert(set_.members.end(), joined_.begin(), joined_.end());
  fit(nodes, joined_, params_.bar.max_noise_share, a);
}

void BarSearch::merge_pieces(const BarNodes& nodes) {
  std::vector<Bar>& rungs = set_.rungs;
  for (std::size_t i = 0; i < rungs.size(); ++i) {
    for (std::size_t j = i + 1; j < rungs.size();) {
      if (are_pieces(rungs[i], rungs[j])) {
        join(nodes, rungs[i], rungs[j]);
        rungs.erase(rungs.begin() + j);
        j = i + 1;
      } else {
        ++j;
      }
    }
  }
}

void BarSearch::merge_rails() {
  const BarParams& p = params_.bar;
  std::vector<Bar>& rails = set_.rails;
  for (std::size_t i = 0; i < rails.size(); ++i) {
    for (std::size_t j = i + 1; j < rails.size();) {
      const bool same =
          std::abs(rails[i].axis.direction.dot(rails[j].axis.direction)) > p.rail_merge_min_cos &&
          rails[i].axis.distance(rails[j].axis.origin_m) < p.rail_merge_offset_m;
      if (!same) {
        ++j;
        continue;
      }
      if (rails[j].support() > rails[i].support()) rails[i] = rails[j];
      rails.erase(rails.begin() + j);
    }
  }
}

}  // namespace ladder
