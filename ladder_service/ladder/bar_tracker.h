// SPDX-License-Identifier: BSD-3-Clause
// Memory of the default mode: bars matched from frame to frame, evidence counted, positions
// averaged.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "ladder/bar_detector.h"
#include "ladder/estimate.h"
#include "ladder/measured_bar.h"
#include "ladder/params.h"

namespace ladder {

struct BarTrack {
  int id = 0;
  MeasuredBar bar;  ///< ends, sag and angles averaged; the rest from the last match
  int num_matches = 0;
  int presence = 0;        ///< +1 matched, -1 not; the track ends at 0
  int evidence = 0;        ///< +1 matched on a ladder, -1 not
  int num_missed = 0;      ///< frames since the last match on a ladder
  bool is_proven = false;  ///< evidence reached trust and has not fallen below drop since
  Eigen::Matrix3d scatter_m2 = Eigen::Matrix3d::Zero();  ///< of one frame's middle point
  double averaging = 1.0;  ///< variance of the averaged middle point / that of one frame's

  Eigen::Matrix3d covariance_m2(const TrackParams& params) const;
  /// How far one frame's middle point lies from the average, r.m.s.; where the ladder moves and
  /// nobody says so, as far as the average lags.
  double wander_m() const { return std::sqrt(scatter_m2.trace()); }
  double wander_along_m() const;
  std::uint16_t flags(const MeasureParams& params) const;
};

class BarTracker {
 public:
  explicit BarTracker(const LadderParams& params);
  void update(const std::vector<MeasuredBar>& bars);
  void reset();

  const std::vector<BarTrack>& tracks() const { return tracks_; }  ///< ascending id

 private:
  int find_match(const BarTrack& track, const std::vector<MeasuredBar>& bars) const;
  void take(BarTrack& track, const MeasuredBar& bar) const;
  void miss(BarTrack& track) const;
  void count_evidence(BarTrack& track, bool on_ladder) const;
  void begin(const MeasuredBar& bar);

  LadderParams params_;
  std::vector<BarTrack> tracks_;
  std::vector<char> matched_;
  int next_id_ = 1;
};

}  // namespace ladder
