// SPDX-License-Identifier: BSD-3-Clause
// A straight chain of nodes, level (may be a rung) or upright (may be a rail), and the set of them
// found in one frame.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "ladder/axis.h"
#include "ladder/bar_nodes.h"
#include "ladder/principal_axis.h"

namespace ladder {

/// What a bar may take in around its axis: an ellipse, longer along the view, where the noise of
/// the range scatters points, than across it.
struct CrossSection {
  Eigen::Vector3d depth = Eigen::Vector3d::UnitX();  ///< unit, along the view, across the axis
  double half_height_m = 1.0;
  double half_depth_m = 1.0;  ///< >= half_height_m

  /// Of `across_m` from the axis, what lies along the view counting as much less as noise reaches
  /// farther there.
  double distance_m(const Eigen::Vector3d& across_m) const {
    const double q_m = across_m.dot(depth);
    const double height2_m2 = std::max(0.0, across_m.squaredNorm() - q_m * q_m);
    const double scaled_m = q_m * half_height_m / half_depth_m;
    return std::sqrt(height2_m2 + scaled_m * scaled_m);
  }
};

struct Bar {
  Axis axis;  ///< through the mean of the points; a rung's points right as the robot sees it
  double from_m = 0.0;  ///< first and last member along the axis
  double to_m = 0.0;
  MomentSum sum;
  PrincipalAxis spread;
  Eigen::Vector3d eye_m = Eigen::Vector3d::Zero();  ///< mean position of the heads that saw it
  CrossSection section;
  int first_member = 0;  ///< into BarSet::members
  int num_members = 0;
  bool wide = false;      ///< found at the wide half height
  bool doubtful = false;  ///< narrow, but what lies around it may belong to it

  double length_m() const { return to_m - from_m; }
  /// From the axis, in its section's measure.
  double distance_m(const Eigen::Vector3d& p) const { return section.distance_m(axis.across(p)); }
  double support() const { return sum.weight * length_m(); }
};

/// Refits axis, extent, weight and eye to the members; keeps the sense of the old direction. False
/// for fewer than 3 members.
bool fit(const BarNodes& nodes, std::span<const int> members, double max_noise_share, Bar& bar);

struct BarSet {
  std::vector<Bar> rungs, rails;
  std::vector<int> members;  ///< indices into the nodes, a stretch per bar

  std::span<const int> members_of(const Bar& bar) const {
    return {members.data() + bar.first_member, static_cast<std::size_t>(bar.num_members)};
  }
};

}  // namespace ladder
