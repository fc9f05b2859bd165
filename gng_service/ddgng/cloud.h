// SPDX-License-Identifier: BSD-3-Clause
// The input of one frame: a view of points in the odom frame (z up against gravity).
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "ddgng/topology.h"

namespace ddgng {

/// x_m, y_m, z_m and head have the same length; coordinates are finite.
struct CloudView {
  std::span<const float> x_m, y_m, z_m;
  std::span<const std::uint8_t> head;  ///< 0..3
  std::array<Eigen::Vector3f, kNumHeads> head_position_m{};
  std::array<bool, kNumHeads>
      head_valid{};  ///< false: this head gave no point and its position means nothing
  Eigen::Vector2f ahead = Eigen::Vector2f::UnitX();  ///< unit, level: where the body looks
  float range_max_m = 4.0F;
  float time_step_s = 0.0F;  ///< since the previous frame; 0 on the first
  std::uint64_t sequence =
      0;  ///< the random numbers of this frame depend on (seed, sequence) alone

  std::size_t size() const { return x_m.size(); }
};

}  // namespace ddgng
