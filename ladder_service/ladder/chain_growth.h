// SPDX-License-Identifier: BSD-3-Clause
// Grows a bar from a seed: takes the nodes near the line outwards up to the first gap, fits the
// line to them, and repeats.
#pragma once

#include <vector>

#include "ladder/bar.h"
#include "ladder/bar_seeds.h"
#include "ladder/params.h"

namespace ladder {

class ChainGrowth {
 public:
  explicit ChainGrowth(const LadderParams& params);

  /// Appends the members to `set.members` and returns true, or leaves it as it was.
  bool grow(const BarNodes& nodes, const Seed& seed, double half_height_m, BarSet& set, Bar& bar);

 private:
  struct Place {
    double along_m = 0.0;
    int node = 0;
  };
  void follow_noise(double half_height_m, Bar& bar) const;
  void collect_near_line(const BarNodes& nodes, const Bar& bar, bool upright);
  void keep_chain();

  BarParams params_;
  std::vector<Place> near_;
  std::vector<int> chain_;
};

}  // namespace ladder
