// SPDX-License-Identifier: BSD-3-Clause
// The paper's form, Algorithms 3 and 4: writes everything of an estimate but the affordances.
#pragma once

#include <vector>

#include "ladder/affordance.h"
#include "ladder/estimate.h"
#include "ladder/rung_tracker.h"

namespace ladder {

class PaperMode {
 public:
  explicit PaperMode(const LadderParams& params);

  /// `surfaces` becomes parallel to the estimate's rungs.
  void update(const NodeCloud& cloud, LadderEstimate& estimate, std::vector<RungSurface>& surfaces,
              std::vector<RailLine>& rails);
  void reset() { tracker_.reset(); }

 private:
  bool is_rail(const PaperRung& rung) const;
  Rung to_rung(const NodeCloud& cloud, const PaperRung& rung) const;
  RungSurface to_surface(const NodeCloud& cloud, const PaperRung& rung, const Rung& shown) const;
  void write_state(LadderEstimate& estimate);

  LadderParams params_;
  RungTracker tracker_;
  std::vector<int> order_;
  std::vector<double> heights_m_;
};

}  // namespace ladder
