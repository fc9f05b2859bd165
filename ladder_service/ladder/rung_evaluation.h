// SPDX-License-Identifier: BSD-3-Clause
// Algorithm 4: whether the line through two nodes is a rung (Eq. 6 and 7).
#pragma once

#include "ladder/line_support.h"
#include "ladder/paper_rung.h"

namespace ladder {

/// Eq. (6): inliers per decimetre, punished by outliers. 0 for a line without length.
double evaluation(int num_inliers, int num_outliers, double length_m);

class RungEvaluation {
 public:
  explicit RungEvaluation(const LadderParams& params);

  /// Fills `rung` but for id and age, and returns true, when the nodes n1 and n2 are joined along
  /// the line through them and it passes.
  bool evaluate(const NodeCloud& cloud, const Adjacency& graph, int n1, int n2, PaperRung& rung);

 private:
  PaperParams params_;
  LineSupportSearch search_;
};

/// Copies the ids of the support's nodes, as many as the rung has room for.
void remember_members(const NodeCloud& cloud, const LineSupport& support, PaperRung& rung);

}  // namespace ladder
