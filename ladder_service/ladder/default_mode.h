// SPDX-License-Identifier: BSD-3-Clause
// The default mode: bars from moments, ladder test, evidence. Writes everything of an estimate but
// the affordances.
#pragma once

#include <vector>

#include "ladder/affordance.h"
#include "ladder/bar_detector.h"
#include "ladder/bar_tracker.h"
#include "ladder/estimate.h"
#include "ladder/ladder_confirmation.h"
#include "ladder/params.h"
#include "ladder/tread_test.h"

namespace ladder {

class DefaultMode {
 public:
  explicit DefaultMode(const LadderParams& params);

  /// `surfaces` becomes parallel to the estimate's rungs.
  void update(const NodeCloud& cloud, LadderEstimate& estimate, std::vector<RungSurface>& surfaces,
              std::vector<RailLine>& rails);
  void reset();
  const HeadAlignment& alignment() const { return detector_.alignment(); }

 private:
  bool is_published(const BarTrack& track) const;
  void choose_published(const std::vector<BarTrack>& tracks);
  bool is_same_bar(const MeasuredBar& a, const MeasuredBar& b) const;
  double margin_m(const BarTrack& track, double side_sigma_m) const;
  Rung to_rung(const BarTrack& track, bool confirmed) const;
  void write_rails(const Detections& found, LadderEstimate& estimate,
                   std::vector<RailLine>& rails) const;

  LadderParams params_;
  BarDetector detector_;
  BarTracker tracker_;
  LadderConfirmation confirmation_;
  TreadTest treads_;
  std::vector<int> order_;
};

}  // namespace ladder
