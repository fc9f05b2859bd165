// SPDX-License-Identifier: BSD-3-Clause
// Position correction of a known rung: its members are collected again and pull its ends (Eq.
// 8-11).
#pragma once

#include <vector>

#include "ladder/line_support.h"
#include "ladder/paper_rung.h"

namespace ladder {

class RungCorrection {
 public:
  explicit RungCorrection(const LadderParams& params);

  /// False when no member is left: the rung is gone.
  bool correct(const NodeCloud& cloud, const Adjacency& graph, PaperRung& rung);

 private:
  void move_ends(const NodeCloud& cloud, const LineSupport& support, const Axis& line,
                 PaperRung& rung) const;

  PaperParams params_;
  LineSupportSearch search_;
  std::vector<int> starts_;
};

}  // namespace ladder
