// SPDX-License-Identifier: BSD-3-Clause
// Algorithm 4, lines 1-25: the nodes that support a line, found by walking along the graph from the
// nodes it starts at; which of them are inliers and outliers; how far they reach along the line.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ladder/adjacency.h"
#include "ladder/axis.h"
#include "ladder/node_cloud.h"
#include "ladder/params.h"

namespace ladder {

struct LineMember {
  int node = 0;  ///< node index
  bool is_inlier = false;
};

struct LineSupport {
  std::vector<LineMember> members;  ///< in the order they were reached
  int num_inliers = 0;              ///< c_i
  int num_outliers = 0;             ///< c_o
  bool is_connected = false;        ///< c: the target was reached
  double inliers_from_m = 0.0;      ///< extremes of the inliers' projections on the line
  double inliers_to_m = 0.0;
  double members_from_m = 0.0;  ///< ... of all members' projections
  double members_to_m = 0.0;
};

class LineSupportSearch {
 public:
  explicit LineSupportSearch(const LadderParams& params);

  /// Walks from `starts` through nodes nearer to the line than the outlier distance. A node joins
  /// once. target = -1: none. Stands until the next call.
  const LineSupport& collect(const NodeCloud& cloud, const Adjacency& graph, const Axis& line,
                             std::span<const int> starts, int target = -1);

 private:
  void visit(const NodeCloud& cloud, const Axis& line, int node, int target);
  void find_extents(const NodeCloud& cloud, const Axis& line);

  PaperParams params_;
  int max_nodes_;
  LineSupport support_;
  std::vector<std::uint32_t> visited_in_;  ///< per node, number of the search that reached it
  std::uint32_t search_ = 0;
};

}  // namespace ladder
