// SPDX-License-Identifier: BSD-3-Clause
// A LineChip whose wires, losses and refusals the test decides.
#pragma once

#include <string>

#include "gpio/line_chip.h"

namespace gpio {

inline constexpr Levels kAtRest = {false, false, false, false, true};  ///< E-stop not pressed

struct FakeChip : LineChip {
  std::string open() override {
    ++num_opens;
    status = refusal.empty() ? status_when_open : ReadStatus::kLost;
    return refusal;
  }
  ReadStatus read(Levels& read_levels) override {
    if (status == ReadStatus::kDone) read_levels = levels;
    return status;
  }
  int wake_fd() const override { return status == ReadStatus::kLost ? -1 : 77; }
  std::string loss() const override { return "the test took it away"; }

  void lose() { status = ReadStatus::kLost; }
  void press_estop(bool pressed) { levels[kEstop] = !pressed; }

  Levels levels = kAtRest;
  ReadStatus status = ReadStatus::kLost;
  ReadStatus status_when_open = ReadStatus::kDone;
  std::string refusal;
  int num_opens = 0;
};

}  // namespace gpio
