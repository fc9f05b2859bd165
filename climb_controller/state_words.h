// SPDX-License-Identifier: BSD-3-Clause
// climb_state_t in words, for people.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "ladder_msgs/climb_state_t.hpp"

namespace climb_controller::words {

/// "FAULT_HOLD"; "UNKNOWN" for a number that is none.
const char* state(std::int8_t state);
std::optional<std::int8_t> state_from(const std::string& word);

/// "FAULT_HOLD: servo silent", "HOLD".
std::string state_and_reason(const ladder_msgs::climb_state_t& message);

/// Of the last order.
std::string why_refused(const ladder_msgs::climb_state_t& message);

/// Some lines: state, limbs, drives, lines, timing.
std::string overview(const ladder_msgs::climb_state_t& message);

}  // namespace climb_controller::words
