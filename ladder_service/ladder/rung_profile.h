// SPDX-License-Identifier: BSD-3-Clause
// Whether the rungs of a ladder are round or square, from how high they are: a round bar is as high
// from wherever it is seen; a square one shows its underside or its top as well, and is the higher
// the farther above or below the heads it lies.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "ladder/measured_bar.h"

namespace ladder {

class RungProfile {
 public:
  explicit RungProfile(int max_bars) { seen_.reserve(max_bars); }

  /// Rungs of one frame as measured (radius_m half of their height); `up` along the rails.
  void learn(const std::vector<MeasuredBar>& bars, const Eigen::Vector3d& up);
  void reset() { xx_ = xy_ = yy_ = 0.0; }
  bool is_square() const;

 private:
  /// A rung's height as it would be for a square bar of a given side, and as it is.
  struct Seen {
    double expected = 0.0;
    double measured_m = 0.0;
    double weight = 0.0;
  };

  std::vector<Seen> seen_;
  double xx_ = 0.0, xy_ = 0.0, yy_ = 0.0;  ///< of both about their means, as shares of them
};

}  // namespace ladder
