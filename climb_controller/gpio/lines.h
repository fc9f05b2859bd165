// SPDX-License-Identifier: BSD-3-Clause
// Touch switches and E-stop as the controller sees them: levels are truth and are read anew in
// every cycle, edges only wake. A chip that is lost means an active E-stop and open switches until
// it has been found again; that nothing moves then without the operator's reset is the controller's
// part.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "gpio/debounce.h"
#include "gpio/line_chip.h"
#include "gpio/line_params.h"

namespace gpio {

struct LineStates {
  std::array<bool, kNumTouch> touch{};  ///< FL, FR, RL, RR; true = pressed on a rung
  bool estop_active = true;
  bool lost = true;  ///< no levels: everything above is assumed, not read

  friend bool operator==(const LineStates&, const LineStates&) = default;
};

class Lines {
 public:
  /// `chip` outlives the lines. Opens nothing yet: open() or the first poll() does.
  Lines(const LinesParams& params, LineChip& chip);

  /// For the start: "" or what failed, where, and how to mend it. Waits up to `timeout_ms` for the
  /// first levels, which a hub sends when it comes to it.
  std::string open(int timeout_ms = 1000);

  /// To be called in every cycle, and when wake_fd() woke. A lost chip is searched for again, with
  /// backoff. No allocation except while it is lost.
  const LineStates& poll(std::int64_t now_us);

  /// Of the last poll().
  const LineStates& states() const { return states_; }

  /// For ppoll(2): readable when a line changed or the chip went; -1 (ignored) while it is lost.
  int wake_fd() const { return is_open_ ? chip_.wake_fd() : -1; }

  std::int64_t num_losses() const { return num_losses_; }
  /// Why the lines are lost or were last lost, in words; "" = never.
  std::string problem() const;

 private:
  void lose(std::int64_t now_us);
  bool try_open(std::int64_t now_us);

  LinesParams params_;
  LineChip& chip_;
  std::vector<Debounce> debounces_;
  LineStates states_;
  bool is_open_ = false;
  bool are_levels_known_ = false;  ///< since it was opened
  std::int64_t next_attempt_us_ = 0;
  std::int64_t backoff_us_ = 0;
  std::int64_t num_losses_ = 0;
  std::string open_error_;  ///< of the last attempt
};

}  // namespace gpio
