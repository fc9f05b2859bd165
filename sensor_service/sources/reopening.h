// SPDX-License-Identifier: BSD-3-Clause
// When to try a lost device again: after pauses that double from 0.1 to two seconds. Tells whether
// a failure is news, so that an absent device is reported once and not at every attempt.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

namespace sources {

class Reopening {
 public:
  static constexpr std::int64_t kFirstPauseUs = 100'000;
  static constexpr std::int64_t kLongestPauseUs = 2'000'000;

  bool is_due(std::int64_t now_us) const { return now_us >= next_us_; }

  /// True when the reason was not told before.
  bool failed(std::int64_t now_us, const std::string& reason) {
    next_us_ = now_us + pause_us_;
    pause_us_ = std::min(2 * pause_us_, kLongestPauseUs);
    const bool is_news = reason != told_;
    told_ = reason;
    return is_news;
  }

  /// It delivers: the next loss is told, and tried again soon.
  void succeeded() {
    pause_us_ = kFirstPauseUs;
    told_.clear();
  }

 private:
  std::int64_t next_us_ = 0;
  std::int64_t pause_us_ = kFirstPauseUs;
  std::string told_;
};

}  // namespace sources
