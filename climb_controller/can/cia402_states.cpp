// SPDX-License-Identifier: BSD-3-Clause
#include "can/cia402_states.h"

#include <array>

namespace can::cia402 {
namespace {

struct StateRow {
  std::uint16_t mask;
  std::uint16_t value;
  DriveState state;
};

// CiA 402-2, statusword: bit 5 (quick stop) and bit 4 (voltage) do not count where masked out.
constexpr std::array<StateRow, 8> kStates = {{
    {0x4F, 0x00, DriveState::kNotReadyToSwitchOn},
    {0x4F, 0x40, DriveState::kSwitchOnDisabled},
    {0x6F, 0x21, DriveState::kReadyToSwitchOn},
    {0x6F, 0x23, DriveState::kSwitchedOn},
    {0x6F, 0x27, DriveState::kOperationEnabled},
    {0x6F, 0x07, DriveState::kQuickStopActive},
    {0x4F, 0x0F, DriveState::kFaultReactionActive},
    {0x4F, 0x08, DriveState::kFault},
}};

// Rows: goals. Columns: unknown, not ready, switch on disabled, ready to switch on, switched on,
// operation enabled, quick stop active, fault reaction active, fault.
constexpr std::array<std::array<std::uint16_t, kNumDriveStates>, kNumGoals> kWalk = {{
    {0x00, 0x00, 0x00, 0x06, 0x07, 0x0F, 0x0B, 0x00, 0x00},  // kKeep
    {0x00, 0x00, 0x06, 0x07, 0x0F, 0x0F, 0x0F, 0x00, 0x00},  // kEnabled
    {0x0B, 0x00, 0x00, 0x06, 0x07, 0x0B, 0x0B, 0x00, 0x00},  // kQuickStop
    {0x00, 0x00, 0x00, 0x00, 0x06, 0x07, 0x00, 0x00, 0x00},  // kDisabled
    {0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00},  // kNoTorque
}};

}  // namespace

DriveState state_of(std::uint16_t status_word) {
  for (const StateRow& row : kStates) {
    if ((status_word & row.mask) == row.value) return row.state;
  }
  return DriveState::kUnknown;
}

bool has_torque(DriveState state) {
  return state == DriveState::kOperationEnabled || state == DriveState::kQuickStopActive ||
         state == DriveState::kFaultReactionActive;
}

std::uint16_t control_word(Goal goal, DriveState state) {
  return kWalk[static_cast<std::size_t>(goal)][static_cast<std::size_t>(state)];
}

}  // namespace can::cia402
