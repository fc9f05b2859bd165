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

/// What is seen of a rail: the view at a right angle to it, the direction towards the right one,
/// how the points scatter, and how much is lost at either edge.
struct SeenRail {
  Eigen::Vector3d ray = Eigen::Vector3d::UnitX();
  Eigen::Vector3d side = Eigen::Vector3d::UnitY();
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();
  double lost_m = 0.0;
};

/// Half of what is seen of it across the view, and of its front, if it is a flat bar.
struct RailFront {
  double half_seen_m = 0.0;
  double half_m = 0.0;
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
  /// Its front lies along `across`, from rail to rail; zero: at a right angle to the view.
  MeasuredRail measure_rail(const BarFrame& frame, const Bar& rail,
                            const Eigen::Vector3d& across) const;
  /// From the visible front of a round bar to its axis.
  static void push_back(double radius_m, MeasuredBar& bar);
  /// The same for a square one whose height is this many halves of its side.
  static void push_back_square(double height, MeasuredBar& bar);

 private:
  struct Fit;
  bool refit(const BarFrame& frame, const Bar& bar, const Between& rails, Fit& fit) const;
  Eigen::Vector3d rail_direction(const Bar& rail,
                                 const std::array<MomentSum, kNumHeads>& heads) const;
  static RailFront find_front(const SeenRail& seen);
  double lost_m(const BarFrame& frame, const SeenStretch& bar) const;
  void find_ends(const BarFrame& frame, const Bar& bar, const Between& rails, Fit& fit) const;
  void find_radius(const BarFrame& frame, const Bar& bar, Fit& fit) const;
  void find_sag(const BarFrame& frame, const Bar& bar, Fit& fit) const;
  static Eigen::Vector3d level_behind(const Fit& fit);
  double weight_behind(const BarNodes& nodes, const Fit& fit) const;
  void mark_stretches(const BarFrame& frame, const Bar& bar, const Between& rails, Fit& fit) const;

  LadderParams params_;
};

}  // namespace ladder
