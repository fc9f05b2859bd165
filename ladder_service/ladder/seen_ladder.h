// SPDX-License-Identifier: BSD-3-Clause
// What a ladder is by construction, to hold the heads to: straight parallel rungs in one plane at
// whole multiples of one spacing. Each head's own points on them
// are told from where that head stands: of a round bar it sees another front than the next one
// does. Damaged rungs do not take part.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "ladder/alignment_equations.h"
#include "ladder/bar.h"
#include "ladder/node_cloud.h"
#include "ladder/params.h"

namespace ladder {

/// Its nodes between from_m and to_m along its bar's axis; their mean lies front_m before its own
/// axis.
struct SeenRung {
  int bar = 0;    ///< index into BarSet::rungs
  int level = 0;  ///< in spacings above the lowest
  double from_m = 0.0;
  double to_m = 0.0;
  double front_m = 0.0;
  double least_half_height_m = 0.0;  ///< of what is seen of it, for it to be all of it
};

struct SeenLadder {
  int left = -1;  ///< index into BarSet::rails; -1 = no ladder
  int right = -1;
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();     ///< along the rails
  Eigen::Vector3d along = Eigen::Vector3d::UnitY();  ///< from rail to rail, at a right angle to up
  std::vector<SeenRung> rungs;

  bool found() const { return left >= 0; }
};

/// One frame as it came.
struct SeenFrame {
  const NodeCloud& cloud;
  const BarNodes& nodes;
  const BarSet& bars;
};

/// Each of these ascending heights in steps of the smallest above the first; -1: no whole one.
void number_levels(std::span<const double> heights_m, const LadderTestParams& params,
                   std::span<int> levels);

/// Two surfaces: heights of the rungs and their common plane. Both count `share` times. Not the
/// rails: which of their faces are seen depends on the place.
void add_ladder(const SeenFrame& frame, const SeenLadder& ladder, const AlignParams& params,
                double share, AlignmentEquations& equations);

}  // namespace ladder
