// SPDX-License-Identifier: BSD-3-Clause
// Whether the rungs of a ladder are treads: level boards, round which no claw closes. From above or
// below a board is seen to go on behind its front edge; a bar is not, round or square.
#pragma once

#include <utility>
#include <vector>

#include "ladder/axis.h"
#include "ladder/bar_nodes.h"
#include "ladder/measured_bar.h"
#include "ladder/params.h"

namespace ladder {

/// The front of a bar between two places along its axis, and the level direction behind it.
struct BarFront {
  Axis axis;
  double from_m = 0.0;
  double to_m = 0.0;
  Eigen::Vector3d behind = Eigen::Vector3d::UnitX();  ///< unit
};

/// Points at the bar's height, as far behind its front as a tread reaches and a bar does not, less
/// those as far before it: noise puts as many there.
double surplus_behind(const BarNodes& nodes, const BarFront& front, const LadderTestParams& params);

class TreadTest {
 public:
  explicit TreadTest(const LadderParams& params);

  /// The bars of one frame; those of the ladder are looked at. Treads of a ladder are alike, so
  /// what is seen of some decides for all, and lasts while none is seen aslant.
  void learn(const std::vector<MeasuredBar>& bars);
  void reset() { depth_sum_ = weight_ = 0.0; }
  bool has_treads() const;

 private:
  double min_depth_m_;
  std::vector<std::pair<double, double>> depths_;  ///< with their weights
  double depth_sum_ = 0.0;                         ///< depth [m] times weight, older frames less
  double weight_ = 0.0;
};

}  // namespace ladder
