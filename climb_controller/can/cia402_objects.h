// SPDX-License-Identifier: BSD-3-Clause
// The objects that a CiA 402 drive is brought to before it may move, and the parameters of the bus
// that decide their values.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "can/phased_bus.h"
#include "can/sdo_client.h"

namespace can {

/// cycle_us: whole ms up to 100000 (60C2h, 1006h); drive_lost_ms > drive_heartbeat_ms.
struct Cia402Params : BusParams {
  std::vector<std::uint8_t> other_nodes;         ///< nodes that may speak too (gripper I/O)
  std::int64_t master_heartbeat_us = 50'000;     ///< > 0
  int master_lost_ms = 150;                      ///< > master heartbeat (1016h)
  int drive_heartbeat_ms = 100;                  ///< > 0 (1017h)
  bool feed_forward = false;                     ///< RPDO2 with velocity and torque each cycle
  std::vector<cia402::Object> optional_objects;  ///< accepted as they are, absent or other
  SdoClientParams sdo;
};

/// "" or the violated relation in words.
std::string check(const Cia402Params& params);

/// In the order in which they are written; valid configurations only.
std::vector<ObjectStep> configuration_of(const AxisConfig& axis, const Cia402Params& params);

}  // namespace can
