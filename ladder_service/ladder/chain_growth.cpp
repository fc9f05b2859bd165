// SPDX-License-Identifier: BSD-3-Clause
#include "ladder/chain_growth.h"

#include <algorithm>
#include <cmath>

namespace ladder {

ChainGrowth::ChainGrowth(const LadderParams& params) : params_(params.bar) {
  near_.reserve(params.max_nodes);
  chain_.reserve(params.max_nodes);
}

bool ChainGrowth::grow(const BarNodes& nodes, const Seed& seed, double half_height_m, BarSet& set,
                       Bar& bar) {
  bar = Bar{};
  bar.axis = seed.axis;
  for (int i = 0; i < params_.num_refits; ++i) {
    collect_near_line(nodes, bar, half_height_m, seed.upright);
    if (near_.size() < 3) return false;
    keep_chain();
    if (!fit(nodes, chain_, bar)) return false;
  }
  if (set.members.size() + chain_.size() > set.members.capacity()) return false;
  bar.first_member = static_cast<int>(set.members.size());
  bar.num_members = static_cast<int>(chain_.size());
  set.members.insert(set.members.end(), chain_.begin(), chain_.end());
  return true;
}

void ChainGrowth::collect_near_line(const BarNodes& nodes, const Bar& bar, double half_height_m,
                                    bool upright) {
  near_.clear();
  const double rise_m = std::abs(bar.axis.direction.z()) * params_.reach_m + half_height_m;
  const double height_m = bar.axis.origin_m.z();
  const BarNodes::Range range = upright ? BarNodes::Range{0, nodes.size()}
                                        : nodes.between(height_m - rise_m, height_m + rise_m);
  for (int k = range.begin; k < range.end; ++k) {
    const Eigen::Vector3d w = nodes.position_m(k) - bar.axis.origin_m;
    const double t = w.dot(bar.axis.direction);
    if (!upright && std::abs(t) > params_.reach_m) continue;
    if ((w - t * bar.axis.direction).squaredNorm() < half_height_m * half_height_m) {
      near_.push_back({t, k});
    }
  }
}

void ChainGrowth::keep_chain() {
  std::sort(near_.begin(), near_.end(), [](const Place& a, const Place& b) {
    return a.along_m < b.along_m || (a.along_m == b.along_m && a.node < b.node);
  });
  int first = 0;
  const int num_near = static_cast<int>(near_.size());
  for (int i = 1; i < num_near; ++i) {
    if (std::abs(near_[i].along_m) < std::abs(near_[first].along_m)) first = i;
  }
  int last = first;
  while (first > 0 && near_[first].along_m - near_[first - 1].along_m < params_.gap_m) --first;
  while (last + 1 < num_near && near_[last + 1].along_m - near_[last].along_m < params_.gap_m)
    ++last;
  chain_.clear();
  for (int i = first; i <= last; ++i) chain_.push_back(near_[i].node);
}

}  // namespace ladder
