// SPDX-License-Identifier: BSD-3-Clause
// The plant's touch switches and E-stop as the chip that the controller's lines read, in virtual
// time. `lost` plays a GPIO device that is gone.
#pragma once

#include "gpio/line_chip.h"
#include "simulator/plant/robot_plant.h"

namespace robot_in_a_box {

class MemoryChip : public gpio::LineChip {
 public:
  explicit MemoryChip(const simulator::RobotPlant& plant) : plant_(plant) {}

  bool lost = false;

  std::string open() override { return lost ? "the chip is gone" : ""; }
  gpio::ReadStatus read(gpio::Levels& levels) override {
    if (lost) return gpio::ReadStatus::kLost;
    static_assert(gpio::kNumLines == simulator::kNumLines);
    levels = plant_.lines();
    return gpio::ReadStatus::kDone;
  }
  int wake_fd() const override { return -1; }
  std::string loss() const override { return "the chip is gone"; }

 private:
  const simulator::RobotPlant& plant_;
};

}  // namespace robot_in_a_box
