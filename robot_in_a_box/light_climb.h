// SPDX-License-Identifier: BSD-3-Clause
// One climb of light fidelity: the real controller and CAN master against the plant of the
// controller's tests, rungs from truth with perception's error. Ladder, damage and troubles come
// from the seed; an operator arms, sends it up, and resets what has stopped. No physics, no heads.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "robot_in_a_box/trouble.h"

namespace robot_in_a_box {

struct LightClimbParams {
  std::uint64_t seed = 1;
  int num_rungs_to_climb = 4;
  std::int64_t limit_us = 240'000'000;  ///< then it is over, wherever it is
  int max_stops = 6;                    ///< latched ones and refused armings, then enough
  bool has_troubles = true;             ///< else only the ladder is random
};

enum class LightEnd : std::uint8_t { kTop, kHeld, kStopped, kFallen, kTooLong };
inline constexpr int kNumLightEnds = static_cast<int>(LightEnd::kTooLong) + 1;
const char* name(LightEnd end);

struct LightResult {
  LightEnd end = LightEnd::kTooLong;
  const char* reason = "";  ///< of a hold or a stop, in words
  int rungs_climbed = 0;    ///< of the higher front claw, by truth
  std::int64_t duration_us = 0;
};

/// The robot before its ladder, by the seed: pitch 0.25..0.35 m, thick and thin, crooked, missing
/// and weak rungs.
ClimbBoxParams light_box_params(const LightClimbParams& params);

/// `each_cycle` may look on (null: nobody does); `tell` takes the story (null: nobody listens).
LightResult run_light_climb(const LightClimbParams& params, ClimbBox& box,
                            const std::function<void()>& each_cycle = {}, const Tell& tell = {});

}  // namespace robot_in_a_box
