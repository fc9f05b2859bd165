// SPDX-License-Identifier: BSD-3-Clause
// The digital lines between robot and controller. TOUCH_*: high = the claw is pressed on a rung; a
// broken wire reads low, no grasp. ESTOP_N: normally closed, active low; high = run, and a broken
// wire reads low, stop.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace simulator {

enum Line : std::uint8_t { kTouchFl, kTouchFr, kTouchRl, kTouchRr, kEstopN };
inline constexpr int kNumLines = 5;
inline constexpr std::array<const char*, kNumLines> kLineNames = {
    "TOUCH_FL", "TOUCH_FR", "TOUCH_RL", "TOUCH_RR", "ESTOP_N"};
/// true = high.
using LineLevels = std::array<bool, kNumLines>;

/// -1 for an unknown name.
constexpr int line_from_name(std::string_view text) {
  for (int i = 0; i < kNumLines; ++i) {
    if (text == kLineNames[static_cast<std::size_t>(i)]) return i;
  }
  return -1;
}

/// What somebody does to a wire.
enum class WireFault : std::uint8_t { kNone, kStuckLow, kStuckHigh };

constexpr bool level_on_wire(bool level, WireFault fault) {
  if (fault == WireFault::kNone) return level;
  return fault == WireFault::kStuckHigh;
}

}  // namespace simulator
