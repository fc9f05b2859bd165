// SPDX-License-Identifier: BSD-3-Clause
// Tells a service that keeps state from frame to frame when another recording has begun.
#pragma once

#include <cstdint>

namespace runtime {

class RecordingWatch {
 public:
  /// True when utime went backwards, or forwards by more than ten seconds: what was remembered no
  /// longer holds.
  bool is_new(std::int64_t utime_us) {
    const std::int64_t step_us = utime_us - last_us_;
    const bool is_first = last_us_ == 0;
    last_us_ = utime_us;
    step_us_ = is_first ? 0 : step_us;
    if (!is_first && (step_us < 0 || step_us > kJumpUs)) {
      step_us_ = 0;
      return true;
    }
    return false;
  }

  /// Since the message before; 0 for the first of a recording.
  float step_s() const { return static_cast<float>(step_us_) * 1e-6F; }

 private:
  static constexpr std::int64_t kJumpUs = 10'000'000;
  std::int64_t last_us_ = 0;
  std::int64_t step_us_ = 0;
};

}  // namespace runtime
