// SPDX-License-Identifier: BSD-3-Clause
// Confirms a ladder on several frames: proven rungs at equal distances. Its spacing is the slope of
// heights over rung numbers, so missing rungs do no harm.
#pragma once

#include <utility>
#include <vector>

#include "ladder/bar_tracker.h"
#include "ladder/params.h"

namespace ladder {

struct Spacing {
  int num_rungs = 0;
  double spacing_m = 0.0;
  double sigma_m = 0.0;  ///< standard error
};

/// Least-squares spacing of heights (ascending on return). num_rungs = 0 when fewer than three
/// stand at whole multiples of one distance.
Spacing fit_spacing(std::vector<double>& heights_m, const LadderTestParams& params);

/// A bent or tilted rung: both its ends stand this high, and its middle hangs so far below them.
struct DamagedHeight {
  double end0_m = 0.0;
  double end1_m = 0.0;
  double sag_m = 0.0;
};

/// Of two sound rungs, where a damaged one makes the third: with one of its ends, or as far below
/// as it sags, it stands where a rung belongs. The sound ones alone tell the distance.
Spacing fit_spacing_beside(const std::vector<double>& heights_m,
                           const std::vector<DamagedHeight>& damaged,
                           const LadderTestParams& params);

class LadderConfirmation {
 public:
  explicit LadderConfirmation(const LadderParams& params);

  /// Rails are those of the frame; kept, averaged, while a ladder stands.
  LadderState update(const Detections& found, const std::vector<BarTrack>& tracks);
  void reset();

  const Spacing& spacing() const { return spacing_; }
  const std::vector<MeasuredRail>& rails() const { return rails_; }  ///< left, right; or none

 private:
  void follow_rails(const Detections& found);
  bool tells_height(const BarTrack& track) const;
  double max_spacing_sigma_m() const;
  Spacing measure(const std::vector<BarTrack>& tracks);

  LadderParams params_;
  LadderState state_ = LadderState::kUnknown;
  Spacing spacing_;
  double radius_m_ = 0.0;  ///< of its rungs
  std::vector<MeasuredRail> rails_;
  std::vector<double> heights_m_;
  std::vector<DamagedHeight> damaged_;
  std::vector<std::pair<double, double>> radii_;  ///< with their weights
  int num_rail_frames_ = 0;
};

}  // namespace ladder
