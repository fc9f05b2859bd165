// SPDX-License-Identifier: BSD-3-Clause
#include "ladder/line_support.h"

#include <algorithm>
#include <limits>

namespace ladder {

LineSupportSearch::LineSupportSearch(const LadderParams& params)
    : params_(params.paper),
      max_nodes_(params.max_cloud_nodes),
      visited_in_(params.max_cloud_nodes, 0) {
  support_.members.reserve(max_nodes_);
}

const LineSupport& LineSupportSearch::collect(const NodeCloud& cloud, const Adjacency& graph,
                                              const Axis& line, std::span<const int> starts,
                                              int target) {
  if (++search_ == 0) {
    std::fill(visited_in_.begin(), visited_in_.end(), 0U);
    search_ = 1;
  }
  support_.members.clear();
  support_.num_inliers = support_.num_outliers = 0;
  support_.is_connected = false;
  for (const int node : starts) visit(cloud, line, node, target);
  // The list of members is the queue: each one's neighbours are looked at in turn.
  for (std::size_t next = 0; next < support_.members.size(); ++next) {
    for (const int node : graph.neighbors(support_.members[next].node)) {
      visit(cloud, line, node, target);
    }
  }
  find_extents(cloud, line);
  return support_;
}

void LineSupportSearch::visit(const NodeCloud& cloud, const Axis& line, int node, int target) {
  if (node >= max_nodes_ || visited_in_[node] == search_) return;
  visited_in_[node] = search_;
  // PAPER: the author's program measures from the previous node of the chain, which drifts; the
  // line is meant. docs/EQUATIONS.md
  const double rho_m = line.distance(cloud.node_m(node));
  if (!(rho_m < params_.outlier_m)) return;
  const bool is_inlier = rho_m < params_.inlier_m;
  support_.members.push_back({node, is_inlier});
  ++(is_inlier ? support_.num_inliers : support_.num_outliers);
  if (node == target) support_.is_connected = true;
}

void LineSupportSearch::find_extents(const NodeCloud& cloud, const Axis& line) {
  constexpr double kFar = std::numeric_limits<double>::max();
  LineSupport& s = support_;
  s.inliers_from_m = s.members_from_m = kFar;
  s.inliers_to_m = s.members_to_m = -kFar;
  for (const LineMember& member : s.members) {
    const double t = line.along(cloud.node_m(member.node));
    s.members_from_m = std::min(s.members_from_m, t);
    s.members_to_m = std::max(s.members_to_m, t);
    if (!member.is_inlier) continue;
    s.inliers_from_m = std::min(s.inliers_from_m, t);
    s.inliers_to_m = std::max(s.inliers_to_m, t);
  }
  if (s.num_inliers == 0) s.inliers_from_m = s.inliers_to_m = 0.0;
  if (s.members.empty()) s.members_from_m = s.members_to_m = 0.0;
}

}  // namespace ladder
