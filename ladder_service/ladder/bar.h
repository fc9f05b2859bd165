// SPDX-License-Identifier: BSD-3-Clause
// A straight chain of nodes, level (may be a rung) or upright (may be a rail), and the set of them
// found in one frame.
#pragma once

#include <span>
#include <vector>

#include "ladder/axis.h"
#include "ladder/bar_nodes.h"
#include "ladder/principal_axis.h"

namespace ladder {

struct Bar {
  Axis axis;  ///< through the mean of the points; a rung's points right as the robot sees it
  double from_m = 0.0;  ///< first and last member along the axis
  double to_m = 0.0;
  MomentSum sum;
  PrincipalAxis spread;
  Eigen::Vector3d eye_m = Eigen::Vector3d::Zero();  ///< mean position of the heads that saw it
  int first_member = 0;                             ///< into BarSet::members
  int num_members = 0;
  bool wide = false;      ///< found at the wide half height
  bool doubtful = false;  ///< narrow, but what lies around it may belong to it

  double length_m() const { return to_m - from_m; }
  double support() const { return sum.weight * length_m(); }
};

/// Refits axis, extent, weight and eye to the members; keeps the sense of the old direction. False
/// for fewer than 3 members.
bool fit(const BarNodes& nodes, std::span<const int> members, Bar& bar);

struct BarSet {
  std::vector<Bar> rungs, rails;
  std::vector<int> members;  ///< indices into the nodes, a stretch per bar

  std::span<const int> members_of(const Bar& bar) const {
    return {members.data() + bar.first_member, static_cast<std::size_t>(bar.num_members)};
  }
};

}  // namespace ladder
