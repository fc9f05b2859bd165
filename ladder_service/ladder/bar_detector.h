// SPDX-License-Identifier: BSD-3-Clause
// One frame of the default mode: nodes -> bars -> ladder hypothesis -> measured bars. Remembers
// only how the heads sit and what profile the rungs have. Bars that belong to no ladder stay in the
// list, marked as such.
#pragma once

#include <utility>
#include <vector>

#include "ladder/bar_measurement.h"
#include "ladder/bar_nodes.h"
#include "ladder/bar_search.h"
#include "ladder/head_alignment.h"
#include "ladder/ladder_test.h"
#include "ladder/measured_bar.h"
#include "ladder/rung_profile.h"
#include "ladder/seen_ladder.h"

namespace ladder {

struct Detections {
  std::vector<MeasuredBar> bars;    ///< those of the ladder first
  std::vector<MeasuredRail> rails;  ///< the ladder's left and right one first
  bool is_ladder = false;
};

class BarDetector {
 public:
  explicit BarDetector(const LadderParams& params);
  const Detections& detect(const NodeCloud& seen);
  void reset() {
    alignment_.reset();
    forget_rungs();
  }
  const HeadAlignment& alignment() const { return alignment_; }

 private:
  void measure_ladder(const NodeCloud& cloud, const BarSet& bars, const LadderHypothesis& ladder);
  void note_ladder(const BarSet& bars, const LadderHypothesis& ladder);
  bool is_straight(const MeasuredBar& bar) const;
  bool is_exemplary(const MeasuredBar& bar) const;
  void measure_others(const NodeCloud& cloud, const BarSet& bars);
  void push_back_together();
  void forget_rungs();
  double rung_radius_m();
  template <class Counts>
  double median_radius_m(const Counts& counts);
  void join_halves();
  void drop_short_stubs();
  bool is_deep();
  void keep_one_per_level();

  LadderParams params_;
  HeadAlignment alignment_;
  BarNodes nodes_;
  BarSearch search_;
  LadderTest test_;
  BarMeasurement measurement_;
  RungProfile profile_;
  Eigen::Vector3d known_rail_m_ = Eigen::Vector3d::Zero();  ///< a point of the left one, last seen
  double known_radius_m_ = 0.0;                             ///< of the rungs, by many frames
  int num_radii_ = 0;                                       ///< frames that told it
  bool was_square_ = false;
  Detections found_;
  SeenLadder ladder_;
  std::vector<char> used_;
  std::vector<double> deep_;
  std::vector<std::pair<double, double>> radii_;  ///< with their weights
  std::vector<double> heights_m_;
  std::vector<int> levels_;
};

}  // namespace ladder
