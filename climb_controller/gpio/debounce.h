// SPDX-License-Identifier: BSD-3-Clause
// A level counts once it has been seen at every reading for a given time. No clock: the caller says
// when he read.
#pragma once

#include <algorithm>
#include <cstdint>

namespace gpio {

class Debounce {
 public:
  explicit Debounce(std::int64_t hold_us) : hold_us_(hold_us) {}

  /// The next reading counts at once, as the first one does.
  void restart() { is_known_ = false; }

  /// Returns the debounced level.
  bool update(std::int64_t now_us, bool level) {
    if (!is_known_ || level == level_) {
      is_known_ = true;
      level_ = level;
      is_changing_ = false;
      return level_;
    }
    if (!is_changing_) since_us_ = now_us;
    is_changing_ = true;
    since_us_ = std::min(since_us_, now_us);  // a clock that goes back delays nothing
    if (now_us - since_us_ >= hold_us_) {
      level_ = level;
      is_changing_ = false;
    }
    return level_;
  }

 private:
  std::int64_t hold_us_;
  std::int64_t since_us_ = 0;  ///< of the first reading that differed
  bool is_known_ = false;
  bool level_ = false;
  bool is_changing_ = false;
};

}  // namespace gpio
