// SPDX-License-Identifier: BSD-3-Clause
// A simulated scene through the perception chain in virtual time, scored against its truth. The
// result (but for the times measured) is a function of its parameters.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "runtime/config.h"
#include "simulator/score/scorer.h"
#include "simulator/simulation.h"

namespace robot_in_a_box {

struct SceneRunParams {
  simulator::SimulationParams simulation;
  int num_frames = 30;              ///< of each head
  bool odometry = true;             ///< a body that moves says how (LADDER_POSE)
  double odometry_hz = 50.0;        ///< (0, 1000]
  double odometry_sigma_m = 0.001;  ///< of a pose, per axis
  /// Told of everything that goes in (the truth, too) and of topologies and rungs that come out;
  /// none: nobody listens. Must not throw: called from C code.
  std::function<void(const char* channel, std::span<const std::uint8_t> bytes,
                     std::int64_t time_us)>
      listener;
};

/// Throws std::invalid_argument and runtime::ConfigError.
simulator::Score run_scene(const SceneRunParams& params, const runtime::Config& config);

}  // namespace robot_in_a_box
