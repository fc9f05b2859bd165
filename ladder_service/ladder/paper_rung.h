// SPDX-License-Identifier: BSD-3-Clause
// The record R_i of one rung in the paper's form.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "ladder/axis.h"

namespace ladder {

struct PaperRung {
  int id = 0;
  Eigen::Vector3d end1_m = Eigen::Vector3d::Zero();  ///< e1
  Eigen::Vector3d end2_m = Eigen::Vector3d::Zero();  ///< e2
  double evaluation = 0.0;                           ///< R of Eq. (6), nodes per decimetre
  int num_inliers = 0;                               ///< c_i
  int num_outliers = 0;                              ///< c_o
  int age = 0;                                       ///< g
  std::vector<int> member_id;                        ///< node ids, inliers and outliers
  std::vector<int> outlier_id;                       ///< node ids

  double length_m() const { return std::sqrt((end2_m - end1_m).squaredNorm()); }
  Axis axis() const { return {end1_m, unit(end2_m - end1_m, Eigen::Vector3d::UnitX())}; }
};

}  // namespace ladder
