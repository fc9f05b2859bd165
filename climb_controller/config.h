// SPDX-License-Identifier: BSD-3-Clause
// [climb] of the configuration as parameters of cycle, drives, lines and perception.
#pragma once

#include <string>
#include <vector>

#include "climb_controller/control_cycle.h"
#include "climb_controller/drive_layout.h"
#include "climb_controller/perception_inbox.h"
#include "gpio/line_params.h"
#include "runtime/config.h"

namespace climb_controller {

struct ServiceParams {
  CycleParams cycle;  ///< session_id is not configuration
  DriveLayout drives;
  std::string can_interface = "can0";
  bool feed_forward = false;
  std::vector<can::cia402::Object> accepted_objects;  ///< of odd drives: as they are, or absent
  gpio::LinesParams lines;
  climb::AttitudeParams attitude;
  PerceptionParams perception;
  std::string flight_folder;  ///< "" = $STATE_DIRECTORY, else nowhere
};

/// Throws runtime::ConfigError.
ServiceParams read_params(runtime::ConfigTable table);

/// The bus with these drives.
can::Cia402Params bus_params(const ServiceParams& params);

}  // namespace climb_controller
