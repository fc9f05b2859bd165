// SPDX-License-Identifier: BSD-3-Clause
// The nodes off every plane with the moments of their points, in order of height. Rungs are nearly
// level, so the neighbours of a node and the nodes along a rung are a short range of that order: no
// further index is needed.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "ladder/moment_sum.h"
#include "ladder/node_cloud.h"
#include "ladder/params.h"

namespace ladder {

struct BarNode {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< mean of its points
  MomentSum sum;
  Eigen::Vector3d eye_sum_m = Eigen::Vector3d::Zero();  ///< heads' positions times weight
  int node = 0;                                         ///< index into the cloud
  int first_moment = 0;                                 ///< index into the cloud's moments
  int num_moments = 0;
};

/// The sums behind one moment.
MomentSum to_sum(const HeadMoment& moment);

class BarNodes {
 public:
  struct Range {
    int begin = 0;
    int end = 0;
  };

  explicit BarNodes(const LadderParams& params);

  /// Takes the nodes off every plane that hold enough points; above the capacity those with the
  /// most points.
  void gather(const NodeCloud& cloud);

  int size() const { return static_cast<int>(nodes_.size()); }
  const BarNode& operator[](int i) const { return nodes_[i]; }
  const Eigen::Vector3d& position_m(int i) const { return position_m_[i]; }
  const MomentSum& sum(int i) const { return sum_[i]; }
  double weight(int i) const { return sum_[i].weight; }
  /// Nodes with from_m <= height <= to_m.
  Range between(double from_m, double to_m) const;

 private:
  bool pool(const NodeCloud& cloud, int node, int first_moment, BarNode& out) const;

  int max_nodes_;
  double min_weight_;
  double weight_without_moments_;
  std::vector<BarNode> unordered_, nodes_;
  std::vector<int> order_;
  // Copies of what the inner loops read, close together in memory.
  std::vector<Eigen::Vector3d> position_m_;
  std::vector<MomentSum> sum_;
  std::vector<double> height_m_;
};

}  // namespace ladder
