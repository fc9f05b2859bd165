// SPDX-License-Identifier: BSD-3-Clause
// Between messages and the controller's structures: no arithmetic beyond copying.
#pragma once

#include "climb_controller/control_cycle.h"
#include "ladder_msgs/climb_state_t.hpp"
#include "ladder_msgs/command_t.hpp"
#include "ladder_msgs/pose_t.hpp"

namespace climb_controller {

climb::OperatorCommand to_command(const ladder_msgs::command_t& message);

/// Fills everything but utime, seq, session_id and what is counted over cycles.
void to_message(const CycleReport& report, ladder_msgs::climb_state_t& message);

/// Fills everything but utime and seq.
void to_message(const climb::OdometryEstimate& pose, ladder_msgs::pose_t& message);

}  // namespace climb_controller
