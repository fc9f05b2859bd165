// SPDX-License-Identifier: BSD-3-Clause
// What Lines needs of whatever carries the five wires: a GPIO chip, a line hub, or wires within the
// process. Raw levels only; polarity, debouncing and what a loss means are decided in Lines.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "gpio/line_params.h"

namespace gpio {

enum class ReadStatus : std::uint8_t {
  kDone,
  kPending,  ///< open, but not every level is known yet
  kLost,     ///< gone: not to be read again before the next open()
};

class LineChip {
 public:
  virtual ~LineChip() = default;

  /// "" or what failed, where, and how to mend it. Finds the chip anew by its name. Never waits.
  virtual std::string open() = 0;

  /// The levels of this moment; takes away the edges that woke us. No allocation, never waits.
  virtual ReadStatus read(Levels& levels) = 0;

  /// Becomes readable when a level changes or the chip goes; -1 while it is not open.
  virtual int wake_fd() const = 0;

  /// Why read() said kLost, in words.
  virtual std::string loss() const = 0;
};

/// The chip that `params.chip` names. Opens nothing yet.
std::unique_ptr<LineChip> make_line_chip(const LinesParams& params);

}  // namespace gpio
