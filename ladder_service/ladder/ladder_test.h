// SPDX-License-Identifier: BSD-3-Clause
// Whether two rails and the bars between them form a ladder, from one frame: parallel rails, bars
// joined to both at a regular spacing, and nothing in the panels between them.
#pragma once

#include <vector>

#include "ladder/bar.h"
#include "ladder/params.h"

namespace ladder {

struct Joint {
  int bar = 0;  ///< index into BarSet::rungs
  bool reaches_left = false;
  bool reaches_right = false;
  double height_m = 0.0;  ///< along the left rail

  bool is_whole() const { return reaches_left && reaches_right; }
};

/// Indices into BarSet::rails, left and right as the robot sees them; -1 = no ladder.
struct LadderHypothesis {
  int left = -1;
  int right = -1;
  double score = 0.0;
  std::vector<Joint> joints;

  bool found() const { return left >= 0; }
};

class LadderTest {
 public:
  explicit LadderTest(const LadderParams& params);

  /// The best pair of rails; stands until the next call.
  const LadderHypothesis& find(const BarNodes& nodes, const BarSet& bars,
                               const Eigen::Vector3d& body_m);

 private:
  bool are_rails(const Bar& left, const Bar& right) const;
  bool joint(const BarSet& bars, const Bar& bar, Joint& out) const;
  void collect_joints(const BarSet& bars);
  bool has_rungs();
  int num_regular_steps(bool whole_only);
  double hole_ratio(const BarNodes& nodes, const BarSet& bars) const;

  LadderTestParams params_;
  LadderHypothesis trial_, best_;
  std::vector<double> heights_m_;
};

}  // namespace ladder
