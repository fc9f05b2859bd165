// SPDX-License-Identifier: BSD-3-Clause
#include "ladder/rung_evaluation.h"

#include <array>

namespace ladder {

double evaluation(int num_inliers, int num_outliers, double length_m) {
  if (!(length_m > 0.0)) return 0.0;
  constexpr double kDecimeter_m = 0.1;
  // PAPER: printed as a product with the length; the quotient is meant. docs/EQUATIONS.md
  return num_inliers / ((1.0 + num_outliers) * (length_m / kDecimeter_m));  // Eq. (6)
}

void remember_members(const NodeCloud& cloud, const LineSupport& support, PaperRung& rung) {
  rung.member_id.clear();
  rung.outlier_id.clear();
  for (const LineMember& member : support.members) {
    if (rung.member_id.size() == rung.member_id.capacity()) break;
    rung.member_id.push_back(cloud.id[member.node]);
    if (!member.is_inlier) rung.outlier_id.push_back(cloud.id[member.node]);
  }
}

RungEvaluation::RungEvaluation(const LadderParams& params)
    : params_(params.paper), search_(params) {}

bool RungEvaluation::evaluate(const NodeCloud& cloud, const Adjacency& graph, int n1, int n2,
                              PaperRung& rung) {
  const Eigen::Vector3d h1 = cloud.node_m(n1);
  const Eigen::Vector3d difference = h1 - cloud.node_m(n2);
  const double distance_m = std::sqrt(difference.squaredNorm());
  if (!(distance_m > 0.0)) return false;
  const Axis line{h1, difference / distance_m};  // Alg. 4, line 1

  // Lines 2-15: members by graph search, inliers and outliers counted.
  const std::array<int, 1> starts = {n1};
  const LineSupport& support = search_.collect(cloud, graph, line, starts, n2);
  if (!support.is_connected) return false;  // Fig. 3
  if (support.num_inliers < params_.min_inliers) return false;
  if (support.num_inliers <= params_.inlier_ratio * support.num_outliers) return false;

  // Lines 16-25: the nested tests keep the extreme projections of the inliers.
  rung.end1_m = line.at(support.inliers_from_m);
  rung.end2_m = line.at(support.inliers_to_m);
  const double length_m = support.inliers_to_m - support.inliers_from_m;
  if (length_m < params_.min_length_m) return false;
  rung.num_inliers = support.num_inliers;
  rung.num_outliers = support.num_outliers;
  rung.evaluation = evaluation(support.num_inliers, support.num_outliers, length_m);
  if (rung.evaluation < params_.xi) return false;  // Eq. (7)
  remember_members(cloud, support, rung);
  return true;
}

}  // namespace ladder
