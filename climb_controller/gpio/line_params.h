// SPDX-License-Identifier: BSD-3-Clause
// Which five inputs the controller reads and how they are wired. Names rather than numbers: the
// kernel counts its chips anew at every start.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace gpio {

inline constexpr int kNumTouch = 4;  ///< FL, FR, RL, RR
inline constexpr int kEstop = kNumTouch;
inline constexpr int kNumLines = kNumTouch + 1;

/// Of the wires, in the order FL, FR, RL, RR, E-stop; true = high.
using Levels = std::array<bool, kNumLines>;

/// What the chip does with a wire nobody drives.
enum class Bias : std::uint8_t { kAsIs, kDisabled, kPullUp, kPullDown };

struct LineParams {
  std::string name;              ///< as `gpioinfo` shows it; "" = by offset
  int offset = -1;               ///< on the chip, for chips that name no lines; -1 = by name
  bool active_low = false;       ///< low = pressed
  Bias bias = Bias::kPullDown;   ///< so that a broken wire reads "no grasp" or "stop"
  std::int64_t debounce_us = 0;  ///< 0..10'000: a level counts once it has lasted so long
};

struct LinesParams {
  std::string chip =
      "ladder-gpio";  ///< label as `gpiodetect` shows it, or "unix:PATH" (a line hub)
  /// Their 30 ms filter is the grasp confirmation's; here they pass as they are.
  std::array<LineParams, kNumTouch> touch = {LineParams{"TOUCH_FL"}, LineParams{"TOUCH_FR"},
                                             LineParams{"TOUCH_RL"}, LineParams{"TOUCH_RR"}};
  /// Normally closed to the supply: high = run; pressed, or with a broken wire, low = stop.
  LineParams estop{"ESTOP_N", -1, true, Bias::kPullDown, 5'000};
  std::int64_t first_reopen_us = 50'000;     ///< > 0; wait before a lost chip is tried; doubles
  std::int64_t longest_reopen_us = 800'000;  ///< >= first_reopen_us; found within 1 s of return

  const LineParams& line(int index) const { return index == kEstop ? estop : touch[index]; }
};

/// "" or the violated relation, naming the field. Refuses wiring on which a broken wire would read
/// as "run" or as a grasp.
std::string check(const LinesParams& params);

}  // namespace gpio
