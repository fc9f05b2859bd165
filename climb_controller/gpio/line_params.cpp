// SPDX-License-Identifier: BSD-3-Clause
#include "gpio/line_params.h"

#include <cstddef>

namespace gpio {
namespace {

constexpr const char* kKeys[kNumLines] = {"touch_fl", "touch_fr", "touch_rl", "touch_rr", "estop"};
constexpr std::int64_t kMaxDebounce_us = 10'000;  // and two periods of 10 ms, at most, make 30 ms
constexpr std::size_t kMaxPath = 107;             // of a unix socket

/// The level that a wire takes when it breaks, if the chip decides it.
bool breaks_to(const LineParams& line, bool level) {
  return line.bias == (level ? Bias::kPullUp : Bias::kPullDown);
}

std::string check_line(const LineParams& line, int index) {
  const std::string key = kKeys[index];
  if (line.name.empty() == (line.offset < 0)) {
    return key + ": give either its name or its offset (>= 0) on the chip";
  }
  if (!(line.debounce_us >= 0 && line.debounce_us <= kMaxDebounce_us)) {
    return key + "_debounce_us must be in 0..10000";
  }
  const bool active_level = !line.active_low;
  if (index == kEstop && breaks_to(line, !active_level)) {
    return key +
           ": a broken wire would read as run; use bias pull_down with active_low = true, or "
           "pull_up with active_low = false";
  }
  if (index != kEstop && breaks_to(line, active_level)) {
    return key +
           ": a broken wire would read as a grasp; use bias pull_down with active_low = "
           "false, or pull_up with active_low = true";
  }
  return "";
}

}  // namespace

std::string check(const LinesParams& params) {
  if (params.chip.empty()) return "chip must be the label of a GPIO chip, or unix:PATH";
  if (params.chip.starts_with("unix:")) {
    const std::size_t length = params.chip.size() - 5;
    if (length == 0 || length > kMaxPath)
      return "chip: the path in unix:PATH has 1..107 characters";
  }
  for (int i = 0; i < kNumLines; ++i) {
    if (std::string error = check_line(params.line(i), i); !error.empty()) return error;
    for (int k = 0; k < i; ++k) {
      const LineParams& a = params.line(i);
      const LineParams& b = params.line(k);
      if (a.name == b.name && a.offset == b.offset) {
        return std::string(kKeys[k]) + " and " + kKeys[i] + " are the same line";
      }
    }
  }
  if (params.first_reopen_us <= 0) return "first_reopen_us must be above 0";
  if (params.longest_reopen_us < params.first_reopen_us) {
    return "longest_reopen_us must be at least first_reopen_us";
  }
  return "";
}

}  // namespace gpio
