// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/head_layout.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace simulator {

using Eigen::Vector3d;

HeadLayout heads_still() {
  return {{
      {{0.02, 0.03, 0.02}, 28.0, 20.0},
      {{0.02, -0.03, 0.02}, -28.0, 20.0},
      {{0.02, 0.03, -0.02}, 28.0, -20.0},
      {{0.02, -0.03, -0.02}, -28.0, -20.0},
  }};
}

HeadLayout heads_climb() {
  // On the ladder body x points up along it and -z at it: pitch -90 looks straight at the rungs.
  // Together they see from 0.32 m below the body's origin to 1.0 m above it, without a gap where a
  // claw may want to grasp.
  return {{
      {.p_body_head_m = {0.30, 0.0, 0.0}, .pitch_deg = -45.0},
      {.p_body_head_m = {-0.44, 0.0, 0.0}, .pitch_deg = -45.0},
      {.p_body_head_m = {0.30, 0.06, 0.0}, .pitch_deg = -70.0, .portrait = true, .splay_deg = 15.0},
      {.p_body_head_m = {0.30, -0.06, 0.0},
       .pitch_deg = -70.0,
       .portrait = true,
       .splay_deg = -15.0},
  }};
}

HeadLayout head_layout_from_string(std::string_view name) {
  if (name == "heads_still") return heads_still();
  if (name == "heads_climb") return heads_climb();
  throw std::invalid_argument("unknown head layout \"" + std::string(name) +
                              "\"; known are heads_still, heads_climb");
}

Eigen::Isometry3d T_body_head(const HeadMount& mount) {
  const double yaw = mount.yaw_deg * std::numbers::pi / 180.0;
  const double pitch = mount.pitch_deg * std::numbers::pi / 180.0;
  const double splay = mount.splay_deg * std::numbers::pi / 180.0;
  const Vector3d ahead(std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw),
                       std::sin(pitch));
  const Vector3d aside(-std::sin(yaw), std::cos(yaw), 0.0);  // to the left
  const Vector3d forward = std::cos(splay) * ahead + std::sin(splay) * aside;
  const Vector3d right = std::sin(splay) * ahead - std::cos(splay) * aside;
  const Vector3d down = forward.cross(right);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = mount.p_body_head_m;
  if (mount.portrait) {
    pose.linear() << down, -right, forward;
  } else {
    pose.linear() << right, down, forward;
  }
  return pose;
}

}  // namespace simulator
