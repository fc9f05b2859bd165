// SPDX-License-Identifier: BSD-3-Clause
#include "ladder/rung_correction.h"

#include <algorithm>

#include "ladder/rung_evaluation.h"

namespace ladder {

RungCorrection::RungCorrection(const LadderParams& params)
    : params_(params.paper), search_(params) {
  starts_.reserve(params.max_nodes);
}

bool RungCorrection::correct(const NodeCloud& cloud, const Adjacency& graph, PaperRung& rung) {
  const Axis line = rung.axis();
  // Old members that still stand; those too far from the line drop out in the search.
  starts_.clear();
  for (const int id : rung.member_id) {
    const auto found = std::lower_bound(cloud.id.begin(), cloud.id.end(), id);
    if (found == cloud.id.end() || *found != id) continue;
    if (starts_.size() == starts_.capacity()) break;
    starts_.push_back(static_cast<int>(found - cloud.id.begin()));
  }
  const LineSupport& support = search_.collect(cloud, graph, line, starts_);
  if (support.members.empty()) return false;
  rung.num_inliers = support.num_inliers;
  rung.num_outliers = support.num_outliers;
  rung.evaluation = evaluation(support.num_inliers, support.num_outliers,
                               support.members_to_m - support.members_from_m);
  move_ends(cloud, support, line, rung);
  remember_members(cloud, support, rung);
  return true;
}

void RungCorrection::move_ends(const NodeCloud& cloud, const LineSupport& support, const Axis& line,
                               PaperRung& rung) const {
  const Eigen::Vector3d b1 = line.at(support.members_from_m);
  const Eigen::Vector3d b2 = line.at(support.members_to_m);
  rung.end1_m = b1;
  rung.end2_m = b2;
  const double length_m = support.members_to_m - support.members_from_m;
  // PAPER: the divisor is c_i alone while the sum runs over outliers too. docs/EQUATIONS.md
  if (support.num_inliers == 0 || !(length_m > 0.0)) return;

  Eigen::Vector3d error1_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d error2_m = Eigen::Vector3d::Zero();
  for (const LineMember& member : support.members) {
    const Eigen::Vector3d h = cloud.node_m(member.node);
    const Eigen::Vector3d offset_m = -line.across(h);  // from the node to the line
    const double t = line.along(h);
    // PAPER: Eq. (8)-(9) print the two weights exchanged; a node near an end moves that end, as in
    // the author's program. docs/EQUATIONS.md
    error1_m += (support.members_to_m - t) / length_m * offset_m;    // Eq. (8)
    error2_m += (t - support.members_from_m) / length_m * offset_m;  // Eq. (9)
  }
  error1_m /= support.num_inliers;
  error2_m /= support.num_inliers;
  rung.end1_m = b1 - params_.gamma * error1_m;  // Eq. (10)
  rung.end2_m = b2 - params_.gamma * error2_m;  // Eq. (11)
}

}  // namespace ladder
