// SPDX-License-Identifier: BSD-3-Clause
// Which fault leads to which reaction in which state: one table, one pure function. The strongest
// reaction wins; among equals the fault that stands higher in the table is the one reason told.
// What concerns only one message (bad, late, wrong session) is dropped where it is read; what
// concerns only one reach (target withdrawn, touch late) is in limb_state.h.
#pragma once

#include <cstdint>
#include <span>

#include "climb/controller_state.h"

namespace climb {

enum class Fault : std::uint8_t {
  kEstop,
  kLinesLost,  ///< the GPIO device is gone: the E-stop cannot be read
  kFreeFall,
  kTooFewGrasps,  ///< fewer than three claws hold, off the ground: fall alarm
  kBusDown,       ///< bus-off, error-passive, interface down or gone
  kTransmitStalled,
  kSecondController,
  kServoFault,
  kServoSilent,
  kServoState,  ///< boot-up, pre-operational or not enabled, unasked
  kHeartbeatLost,
  kTracking,  ///< following error, jump, wrong sign
  kMalformedFrames,
  kUnsafeCommand,  ///< the gate refused our own command
  kOverrun,        ///< more than three periods
  kSuspended,      ///< the machine slept
  kTilt,
  kImuSilent,
  kTouchStuck,
  kGraspDisagrees,  ///< three times
  kStanceLost,
  kNoGrasp,  ///< all tries used up
  kConfiguration,
  kTerminate,     ///< the service is asked to end
  kServoWarning,  ///< under-voltage or over-temperature ahead
  kPerceptionSilent,
  kNone
};
inline constexpr int kNumFaults = static_cast<int>(Fault::kNone);

const char* name(Fault fault);

/// A set of faults, one bit each.
using FaultFlags = std::uint32_t;

constexpr FaultFlags flag(Fault fault) {
  return fault == Fault::kNone ? 0U : FaultFlags{1} << static_cast<int>(fault);
}

/// Weakest first.
enum class Reaction : std::uint8_t {
  kNothing,
  kBlock,           ///< may not be armed; arming ends
  kFinishStep,      ///< the limb in the air finishes its step, then HOLD
  kProtectiveHold,  ///< stop along the path, go on when the cause is gone
  kFaultHold,       ///< stop along the path, torque on, latched
  kEstop            ///< quick stop of all drives, latched
};
inline constexpr int kNumReactions = static_cast<int>(Reaction::kEstop) + 1;

const char* name(Reaction reaction);

struct Action {
  Reaction reaction = Reaction::kNothing;
  Fault reason = Fault::kNone;  ///< exactly one, whenever there is a reaction
  bool latched = false;         ///< until reset by the operator
  bool silent = false;          ///< nothing may be sent: the drives hold by themselves
  bool close_claws = false;

  friend bool operator==(const Action&, const Action&) = default;
};

Action failsafe(FaultFlags flags, ControllerState state);

/// Faults that forbid a reset as long as they are there.
FaultFlags forbidding_reset();

/// Columns of the table: states in which a fault means the same.
enum class StateGroup : std::uint8_t { kUnpowered, kArming, kStanding, kClimbing, kLatched };
inline constexpr int kNumStateGroups = static_cast<int>(StateGroup::kLatched) + 1;

StateGroup group_of(ControllerState state);

struct FailsafeRow {
  Fault fault;
  const char* name;
  Reaction unpowered, arming, standing, climbing, latched;
  bool silent;
  bool close_claws;

  constexpr Reaction in(StateGroup group) const {
    const Reaction columns[kNumStateGroups] = {unpowered, arming, standing, climbing, latched};
    return columns[static_cast<int>(group)];
  }
};

std::span<const FailsafeRow> failsafe_table();

}  // namespace climb
