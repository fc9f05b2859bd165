// SPDX-License-Identifier: BSD-3-Clause
// The power state machine of CiA 402 (IEC 61800-7-201), one drive's side: what a control word does
// in each state. Pure; ramps, errors and voltage belong to the drive.
#pragma once

#include <cstdint>

namespace simulator {

enum class PowerState : std::uint8_t {
  kNotReadyToSwitchOn,
  kSwitchOnDisabled,
  kReadyToSwitchOn,
  kSwitchedOn,
  kOperationEnabled,
  kQuickStopActive,
  kFaultReactionActive,
  kFault,
};
inline constexpr int kNumPowerStates = static_cast<int>(PowerState::kFault) + 1;

const char* name(PowerState state);

/// Bits 0..3, 5 and 6 of the status word.
std::uint16_t status_bits(PowerState state);

/// May the motor have torque?
constexpr bool has_torque(PowerState state) {
  return state == PowerState::kOperationEnabled || state == PowerState::kQuickStopActive ||
         state == PowerState::kFaultReactionActive;
}

struct ControlInputs {
  std::uint16_t control_word = 0;
  bool fault_reset_edge = false;  ///< bit 7 was 0 and is 1
  bool fault_cause_gone = true;
  bool leaves_quick_stop = false;  ///< transition 16 exists (605Ah is 5..8) and is allowed now
};

/// Transitions 2..12, 15 and 16 by control word.
PowerState next_state(PowerState state, const ControlInputs& inputs);

}  // namespace simulator
