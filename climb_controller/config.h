// SPDX-License-Identifier: BSD-3-Clause
// [climb] of the configuration as parameters of cycle, drives, lines and perception.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "climb_controller/control_cycle.h"
#include "climb_controller/drive_layout.h"
#include "climb_controller/perception_inbox.h"
#include "climb_controller/rung_memory.h"
#include "gpio/line_params.h"
#include "runtime/config.h"

namespace climb_controller {

/// What the drives speak.
enum class Protocol : std::uint8_t { kCia402, kOdrive };

struct ServiceParams {
  CycleParams cycle;  ///< session_id is not configuration
  DriveLayout drives;
  std::string can_interface = "can0";
  Protocol protocol = Protocol::kCia402;
  bool feed_forward = false;
  double torque_constant_Nm_A = 0.05;                 ///< ODrive only
  std::vector<can::cia402::Object> accepted_objects;  ///< of odd drives: as they are, or absent
  gpio::LinesParams lines;
  climb::AttitudeParams attitude;
  PerceptionParams perception;
  RungMemoryParams memory;
  std::string flight_folder;  ///< "" = $STATE_DIRECTORY, else nowhere
};

/// Throws runtime::ConfigError.
ServiceParams read_params(runtime::ConfigTable table);

/// The bus with these drives, in their protocol. Transport and recorder (may be null) outlive it.
std::unique_ptr<can::ServoBus> make_servo_bus(const ServiceParams& params,
                                              can::Transport& transport,
                                              can::FlightRecorder* recorder);

}  // namespace climb_controller
