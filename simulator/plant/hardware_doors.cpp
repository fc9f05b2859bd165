// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/plant/hardware_doors.h"

#include <array>

namespace simulator {

HardwareDoors::HardwareDoors(MemoryBus& bus, const std::string& can, const std::string& lines)
    : hub_(bus, open_gateway(can)) {
  const std::string prefix = "unix:";
  if (lines.rfind(prefix, 0) == 0) {
    lines_.emplace(lines.substr(prefix.size()));
  } else if (!lines.empty()) {
    chip_.emplace(lines, std::array<int, kNumLines>{0, 1, 2, 3, 4});
  }
}

void HardwareDoors::wait() {
  descriptors_.clear();
  hub_.gateway().add_to_poll(descriptors_);
  if (lines_) lines_->add_to_poll(descriptors_);
  ::poll(descriptors_.data(), descriptors_.size(), 1);
}

void HardwareDoors::take_in(std::int64_t now_us, RobotPlant& plant) {
  hub_.take_in(now_us);
  if (!lines_) return;
  for (const LineHub::Hand& hand : lines_->receive()) plant.set_wire_fault(hand.line, hand.fault);
}

void HardwareDoors::give_out(std::int64_t now_us, RobotPlant& plant) {
  hub_.give_out(now_us);
  if (lines_) lines_->publish(plant.lines());
  if (chip_) chip_->publish(plant.lines());
}

}  // namespace simulator
