// SPDX-License-Identifier: BSD-3-Clause
// The states of one limb's step and the only ways between them, as a table. What a limb does in a
// state is the limb's business (limb_cycle.h).
#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace climb {

enum class LimbState : std::uint8_t {
  kLoaded,  ///< confirmed grasp, bears its share
  kUnloading,
  kReleasing,
  kRetracting,
  kTransit,
  kPregrasp,  ///< free in front of a rung; also where a limb in the dock begins
  kApproach,
  kClosing,
  kVerify,
  kLoading,
  kRegrasp,      ///< opens again and goes back to before the rung
  kAbortReturn,  ///< on the way back to before the rung that it came from
  kSupportLost   ///< held, and does no longer
};
inline constexpr int kNumLimbStates = static_cast<int>(LimbState::kSupportLost) + 1;

const char* name(LimbState state);

enum class LimbEvent : std::uint8_t {
  kLift,    ///< this limb's turn
  kDone,    ///< what the state does is finished
  kAbort,   ///< the target is withdrawn, or a time is over: back to the old rung
  kMissed,  ///< no grasp there
  kGiveUp,  ///< tries are used up: back to the old rung
  kLost,    ///< a grasp that was confirmed is none
  kProve,   ///< held when nobody watched: it is pulled at
  kPark     ///< in the dock: the claw is off and stays open
};
inline constexpr int kNumLimbEvents = static_cast<int>(LimbEvent::kPark) + 1;

const char* name(LimbEvent event);

struct LimbTransition {
  LimbState from;
  LimbEvent event;
  LimbState to;
};

std::span<const LimbTransition> limb_transitions();

/// The state that follows, or none: the event is refused in this state.
std::optional<LimbState> after(LimbState state, LimbEvent event);

/// The grasp counts as one of the three that must hold.
constexpr bool is_confirmed(LimbState state) {
  return state == LimbState::kLoaded;
}

}  // namespace climb
