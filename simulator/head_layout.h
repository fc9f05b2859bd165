// SPDX-License-Identifier: BSD-3-Clause
// Where the four depth heads sit on the body (x to the head of the robot, y left, z dorsal).
#pragma once

#include <array>
#include <string_view>

#include <Eigen/Geometry>

namespace simulator {

inline constexpr int kNumHeads = 4;

struct HeadMount {
  Eigen::Vector3d p_body_head_m = Eigen::Vector3d::Zero();
  double yaw_deg = 0.0;    ///< to the left
  double pitch_deg = 0.0;  ///< up, towards body z
  bool portrait = false;   ///< turned by 90 deg about the optical axis
  double splay_deg = 0.0;  ///< to the left, about the image's own vertical, after yaw and pitch
};

using HeadLayout = std::array<HeadMount, kNumHeads>;

/// For a robot that stands level before a ladder: 2 x 2 fan; 0 upper left, 1 upper right, 2 lower
/// left, 3 lower right.
HeadLayout heads_still();
/// For the climbing robot, belly to the ladder: 0 the next rungs, 1 from the tail those under the
/// belly, which the rear claws want, 2 and 3 rails and grasp places left and right of the front.
HeadLayout heads_climb();
/// "heads_still" or "heads_climb"; throws std::invalid_argument.
HeadLayout head_layout_from_string(std::string_view name);

/// Head frame: x right, y down, z forward.
Eigen::Isometry3d T_body_head(const HeadMount& mount);

}  // namespace simulator
