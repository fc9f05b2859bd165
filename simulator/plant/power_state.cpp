// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/plant/power_state.h"

#include <array>

namespace simulator {
namespace {

using enum PowerState;

enum class Command : std::uint8_t {
  kNone,
  kDisableVoltage,
  kQuickStop,
  kShutdown,
  kSwitchOn,
  kEnableOperation
};

/// Bits 0 switch on, 1 enable voltage, 2 quick stop (low), 3 enable operation.
Command command_of(std::uint16_t word) {
  if ((word & 0x2) == 0) return Command::kDisableVoltage;
  if ((word & 0x4) == 0) return Command::kQuickStop;
  if ((word & 0x1) == 0) return Command::kShutdown;
  return (word & 0x8) == 0 ? Command::kSwitchOn : Command::kEnableOperation;
}

PowerState from_powered(PowerState state, Command command, bool may_resume) {
  switch (command) {
    case Command::kDisableVoltage:
      return kSwitchOnDisabled;
    case Command::kQuickStop:
      return state == kOperationEnabled  ? kQuickStopActive
             : state == kQuickStopActive ? state
                                         : kSwitchOnDisabled;
    case Command::kShutdown:
      return state == kQuickStopActive ? state : kReadyToSwitchOn;
    case Command::kSwitchOn:
      return state == kQuickStopActive ? state : kSwitchedOn;
    case Command::kEnableOperation:
      return state == kQuickStopActive && !may_resume ? state : kOperationEnabled;
    case Command::kNone:
      break;
  }
  return state;
}

}  // namespace

const char* name(PowerState state) {
  constexpr std::array<const char*, kNumPowerStates> kNames = {
      "not_ready_to_switch_on", "switch_on_disabled", "ready_to_switch_on",    "switched_on",
      "operation_enabled",      "quick_stop_active",  "fault_reaction_active", "fault"};
  return kNames[static_cast<std::size_t>(state)];
}

std::uint16_t status_bits(PowerState state) {
  constexpr std::array<std::uint16_t, kNumPowerStates> kBits = {0x00, 0x40, 0x21, 0x23,
                                                                0x27, 0x07, 0x0F, 0x08};
  return kBits[static_cast<std::size_t>(state)];
}

PowerState next_state(PowerState state, const ControlInputs& inputs) {
  const Command command = command_of(inputs.control_word);
  switch (state) {
    case kNotReadyToSwitchOn:
    case kFaultReactionActive:
      return state;
    case kFault:
      return inputs.fault_reset_edge && inputs.fault_cause_gone ? kSwitchOnDisabled : state;
    case kSwitchOnDisabled:
      return command == Command::kShutdown ? kReadyToSwitchOn : state;
    case kReadyToSwitchOn:
    case kSwitchedOn:
    case kOperationEnabled:
    case kQuickStopActive:
      break;
  }
  return from_powered(state, command, inputs.leaves_quick_stop);
}

}  // namespace simulator
