// SPDX-License-Identifier: BSD-3-Clause
// All bars of one frame: seeds, growth, flank test, duplicates, collinear pieces. Looks first for
// bars of a rung's height, then among what is left for boards: the height is decided per candidate.
#pragma once

#include <cstdint>
#include <vector>

#include "ladder/bar.h"
#include "ladder/bar_seeds.h"
#include "ladder/chain_growth.h"
#include "ladder/params.h"

namespace ladder {

class BarSearch {
 public:
  explicit BarSearch(const LadderParams& params);

  /// Rungs: best supported first. `body_m` decides which way they point (to the robot's right).
  const BarSet& search(const BarNodes& nodes, const Eigen::Vector3d& body_m);

 private:
  void grow_narrow(const BarNodes& nodes);
  void grow_wide(const BarNodes& nodes);
  bool is_long_enough(const Bar& bar, bool upright) const;
  void drop_flanked(const BarNodes& nodes, std::size_t first);
  void drop_duplicates();
  void merge_pieces(const BarNodes& nodes);
  bool are_pieces(const Bar& a, const Bar& b) const;
  void join(const BarNodes& nodes, Bar& a, const Bar& b);
  void merge_rails();

  LadderParams params_;
  ChainGrowth growth_;
  BarSet set_;
  std::vector<Seed> seeds_;
  std::vector<std::uint8_t> in_rung_, in_rail_;
  std::vector<int> joined_;
};

}  // namespace ladder
