// SPDX-License-Identifier: BSD-3-Clause
// The drive state machine of CiA 402 as two tables: which state a statusword means, and which
// controlword to send in each state towards each goal.
#pragma once

#include <cstdint>

#include "can/servo_bus.h"

namespace can::cia402 {

/// Masks 4Fh and 6Fh of CiA 402; kUnknown for a combination that it does not define.
DriveState state_of(std::uint16_t status_word);

/// Torque is on: a wrong controlword lets the limb sag.
bool has_torque(DriveState state);

enum class Goal : std::uint8_t {
  kKeep,       ///< stay in the state it is in, whatever that is
  kEnabled,    ///< 06h -> 07h -> 0Fh; from quick stop straight back (605Ah = 6 allows it)
  kQuickStop,  ///< 0Bh: ramp down and hold
  kDisabled,   ///< 07h -> 06h -> 00h: one step down each cycle
  kNoTorque,   ///< 00h at once
};
inline constexpr int kNumGoals = static_cast<int>(Goal::kNoTorque) + 1;

/// The controlword of this cycle. Never a fault reset: that is an edge, see reset_control_word.
std::uint16_t control_word(Goal goal, DriveState state);

inline constexpr std::uint16_t kFaultResetBit = 0x80;

/// Fault reset by a rising edge of bit 7: 00h, then 80h, then 00h again.
inline std::uint16_t reset_control_word(std::uint16_t last_sent) {
  return (last_sent & kFaultResetBit) != 0 ? std::uint16_t{0} : kFaultResetBit;
}

}  // namespace can::cia402
