// SPDX-License-Identifier: BSD-3-Clause
// The objects that a CiA 402 drive is brought to before it may move, and the parameters of the bus
// that decide their values.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "can/axis_config.h"
#include "can/bus_line.h"
#include "can/sdo_client.h"

namespace can {

struct Cia402Params {
  std::vector<AxisConfig> axes;               ///< 1..32, node_ids differ
  std::vector<std::uint8_t> other_nodes;      ///< nodes that may speak too (gripper I/O)
  std::int64_t cycle_us = 10'000;             ///< whole ms, 1000..100000 (60C2h, 1006h)
  std::int64_t listen_us = 300'000;           ///< before the first frame: is another master here?
  std::int64_t master_heartbeat_us = 50'000;  ///< > 0
  int master_lost_ms = 150;                   ///< > master heartbeat (1016h)
  int drive_heartbeat_ms = 100;               ///< > 0 (1017h)
  int drive_lost_ms = 250;                    ///< > drive_heartbeat_ms
  int max_missed_cycles = 3;                  ///< >= 1: state frames of an axis
  std::int64_t walk_timeout_us = 1'000'000;   ///< for enabling, disabling, starting, fault reset
  bool feed_forward = false;                  ///< RPDO2 with velocity and torque each cycle
  std::vector<cia402::Object> optional_objects;  ///< accepted as absent, though normally required
  SdoClientParams sdo;
  BusLineParams line;
};

/// "" or the violated relation in words.
std::string check(const Cia402Params& params);

/// In the order in which they are written; valid configurations only.
std::vector<ObjectStep> configuration_of(const AxisConfig& axis, const Cia402Params& params);

}  // namespace can
