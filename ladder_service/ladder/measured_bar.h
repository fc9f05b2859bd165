// SPDX-License-Identifier: BSD-3-Clause
// One bar of one frame, measured: axis, ends, radius, damage, and what is seen along it.
#pragma once

#include <bitset>

#include <Eigen/Core>

#include "ladder/axis.h"

namespace ladder {

/// Along a bar from end 0 to end 1, in equal parts of its length.
inline constexpr int kNumStretches = 128;
using Stretches = std::bitset<kNumStretches>;

/// Marks the stretches that overlap [from_m, to_m] of a bar of the given length.
void mark(Stretches& stretches, double from_m, double to_m, double length_m);

struct MeasuredBar {
  Eigen::Vector3d end0_m = Eigen::Vector3d::Zero();  ///< visible front, then axis (push_back)
  Eigen::Vector3d end1_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d depth = Eigen::Vector3d::UnitX();  ///< unit, from the front towards the axis
  double range_m = 0.0;                              ///< from the heads that saw it
  double weight = 0.0;                               ///< points
  double radius_m = 0.0;                             ///< half the height
  double front_m = 0.0;  ///< from the visible front to the axis, once pushed back
  double lost_m = 0.0;   ///< so much of the height is lost at either edge; < 0: gained
  double sag_m = 0.0;
  double bend_tan = 0.0;  ///< of the angle between its halves
  double tilt_sin = 0.0;  ///< of the angle off the right angle to the rails
  double deep = 0.0;      ///< points behind it at its height / own points
  double surplus = 0.0;   ///< points closely behind it less those before it / own points
  bool on_ladder = false;
  bool is_wide = false;      ///< found at the wide half height
  bool is_alike = false;     ///< its radius is that of the ladder's rungs
  bool reaches_end0 = true;  ///< false: ends before the rail
  bool reaches_end1 = true;
  bool is_v = false;  ///< joined from two halves that meet at an angle
  int bar = -1;       ///< index into BarSet::rungs
  int num_inliers = 0;
  int num_outliers = 0;
  Stretches seen;      ///< a node's points lie there
  Stretches attached;  ///< something foreign is near

  Eigen::Vector3d middle_m() const { return 0.5 * (end0_m + end1_m); }
  double length_m() const { return std::sqrt((end1_m - end0_m).squaredNorm()); }
  bool is_stub() const { return !reaches_end0 || !reaches_end1; }
  /// What hides a part of a bar hides of its height, too.
  bool is_whole() const { return seen.count() * 10 >= seen.size() * 9; }
};

/// A rail: its axis between two heights along it, and half its visible width.
struct MeasuredRail {
  Axis axis;  ///< upwards
  double from_m = 0.0;
  double to_m = 0.0;
  double half_width_m = 0.0;
};

}  // namespace ladder
