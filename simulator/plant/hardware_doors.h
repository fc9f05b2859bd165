// SPDX-License-Identifier: BSD-3-Clause
// The plant's doors to a controller process: the servo bus, and the touch switches and the E-stop.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <poll.h>

#include "simulator/plant/bus_hub.h"
#include "simulator/plant/line_hub.h"
#include "simulator/plant/robot_plant.h"

namespace simulator {

class HardwareDoors {
 public:
  /// can: "unix:PATH" (served here) or a CAN interface; lines: "unix:PATH", the sysfs folder of a
  /// gpio-sim chip, or "" for none. Throws DoorError.
  HardwareDoors(MemoryBus& bus, const std::string& can, const std::string& lines);

  /// Until a frame or a record comes, a millisecond at most.
  void wait();
  /// What came in, before the plant advances to now.
  void take_in(std::int64_t now_us, RobotPlant& plant);
  /// What the plant sent and switched, after.
  void give_out(std::int64_t now_us, RobotPlant& plant);

  BusHub& hub() { return hub_; }

 private:
  BusHub hub_;
  std::optional<LineHub> lines_;
  std::optional<SimulatedChip> chip_;
  std::vector<pollfd> descriptors_;
};

}  // namespace simulator
