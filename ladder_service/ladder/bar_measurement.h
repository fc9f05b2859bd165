// SPDX-License-Identifier: BSD-3-Clause
// Measures one bar: refit away from the joints, common direction of the heads, radius and push back
// from the visible front to the axis, ends, damage.
#pragma once

#include <array>
#include <optional>

#include "ladder/backdrop.h"
#include "ladder/bar.h"
#include "ladder/ladder_test.h"
#include "ladder/measured_bar.h"
#include "ladder/node_cloud.h"
#include "ladder/params.h"

namespace ladder {

/// The rails that the bar lies between, or null for a free bar.
struct Between {
  const MeasuredRail* left = nullptr;
  const MeasuredRail* right = nullptr;
};

/// How a rail's width is measured: in this direction, and how much of the variance along the view
/// is the heads' noise.
struct RailView {
  Eigen::Vector3d across = Eigen::Vector3d::Zero();  ///< unit; zero = at a right angle to the view
  double noise_m2 = 0.0;
};

/// What is seen of a rail, from where, and the direction towards the right one.
struct SeenRail {
  Eigen::Vector3d eye_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d side = Eigen::Vector3d::UnitY();
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();
};

/// What one frame gave so far.
struct BarFrame {
  const NodeCloud& cloud;
  const BarNodes& nodes;
  const BarSet& bars;
};

class BarMeasurement {
 public:
  explicit BarMeasurement(const LadderParams& params) : params_(params) {}

  /// Its visible front. Nothing when too few points remain or it touches neither rail.
  std::optional<MeasuredBar> measure(const BarFrame& frame, int bar_index,
                                     const Between& rails) const;
  MeasuredRail measure_rail(const BarFrame& frame, const Bar& rail, const RailView& view) const;
  /// From the visible front of a round bar to its axis.
  static void push_back(double radius_m, MeasuredBar& bar);
  /// The same for a square one whose height is this many halves of its side.
  static void push_back_square(double height, MeasuredBar& bar);
  /// How rails are seen between which these bars lie.
  RailView rail_view(const BarFrame& frame, const LadderHypothesis& ladder) const;

 private:
  struct Fit;
  bool refit(const BarFrame& frame, const Bar& bar, const Between& rails, Fit& fit) const;
  Eigen::Vector3d rail_direction(const Bar& rail,
                                 const std::array<MomentSum, kNumHeads>& heads) const;
  Eigen::Vector3d from_seen_to_middle(const BarFrame& frame, const MeasuredRail& rail,
                                      const SeenRail& seen) const;
  double lost_m(const BarFrame& frame, const SeenStretch& bar) const;
  void find_ends(const BarFrame& frame, const Bar& bar, const Between& rails, Fit& fit) const;
  void find_radius(const BarFrame& frame, const Bar& bar, Fit& fit) const;
  void find_sag(const BarFrame& frame, const Bar& bar, Fit& fit) const;
  double weight_behind(const BarNodes& nodes, const Fit& fit) const;
  void mark_stretches(const BarFrame& frame, const Bar& bar, const Between& rails, Fit& fit) const;

  LadderParams params_;
};

}  // namespace ladder
