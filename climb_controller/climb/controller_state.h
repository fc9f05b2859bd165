// SPDX-License-Identifier: BSD-3-Clause
// The controller's states and the only ways between them, as a table. Names are those published.
// DISARMED follows no target but takes no torque away: only DISARMING walks the drives down, so a
// reset on the ladder leaves them holding by themselves until they are armed again.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace climb {

enum class ControllerState : std::uint8_t {
  kBoot,      ///< nothing heard from drives and lines yet
  kSelftest,  ///< sensors are checked, nothing moves
  kDisarmed,
  kArming,  ///< drives are configured and enabled where they stand; free claws grasp
  kHold,
  kClimbing,
  kPaused,          ///< by the operator
  kProtectiveHold,  ///< goes on by itself when the cause is gone
  kFaultHold,       ///< latched, torque on
  kEstop,           ///< latched, quick stop
  kDisarming        ///< in the dock the claws are opened, then the drives are switched off
};
inline constexpr int kNumControllerStates = static_cast<int>(ControllerState::kDisarming) + 1;

const char* name(ControllerState state);

enum class ControllerEvent : std::uint8_t {
  kBooted,
  kSelftestPassed,
  kArm,  ///< operator
  kArmed,
  kArmingRefused,
  kClimb,  ///< operator
  kPause,  ///< operator
  kHold,   ///< operator, or the goal is reached, or no way on, or no dock to disarm in
  kProtect,
  kRecovered,
  kFault,
  kEstop,
  kReset,   ///< operator; only with the cause cleared
  kDisarm,  ///< operator
  kDisarmed
};
inline constexpr int kNumControllerEvents = static_cast<int>(ControllerEvent::kDisarmed) + 1;

const char* name(ControllerEvent event);

struct ControllerTransition {
  ControllerState from;
  ControllerEvent event;
  ControllerState to;
};

std::span<const ControllerTransition> controller_transitions();

/// The state that follows, or none: the event is refused in this state.
std::optional<ControllerState> after(ControllerState state, ControllerEvent event);

constexpr bool is_latched(ControllerState state) {
  return state == ControllerState::kFaultHold || state == ControllerState::kEstop;
}

/// Targets are followed in these.
constexpr bool is_powered(ControllerState state) {
  return state == ControllerState::kHold || state == ControllerState::kClimbing ||
         state == ControllerState::kPaused || state == ControllerState::kProtectiveHold;
}

}  // namespace climb
