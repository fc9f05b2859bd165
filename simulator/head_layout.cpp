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
  // On the ladder body x points up along it and -z at it. The splayed heads look 45 deg up and 25
  // deg aside: elevation asin(-cos 45 cos 25), azimuth atan(tan 25 / sin 45).
  return {{
      {{0.30, 0.0, 0.0}, 0.0, -45.0, true},
      {{0.30, 0.0, 0.02}, 0.0, -30.0},
      {{0.30, 0.06, 0.0}, 33.40, -39.86, true},
      {{0.30, -0.06, 0.0}, -33.40, -39.86, true},
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
  const Vector3d forward(std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw),
                         std::sin(pitch));
  const Vector3d right(std::sin(yaw), -std::cos(yaw), 0.0);
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
