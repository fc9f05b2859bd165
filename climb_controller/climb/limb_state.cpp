// SPDX-License-Identifier: BSD-3-Clause
#include "climb/limb_state.h"

namespace climb {
namespace {

using E = LimbEvent;

constexpr LimbTransition kTransitions[] = {
    {LimbState::kLoaded, E::kLift, LimbState::kUnloading},
    {LimbState::kUnloading, E::kDone, LimbState::kReleasing},
    {LimbState::kReleasing, E::kDone, LimbState::kRetracting},
    {LimbState::kRetracting, E::kDone, LimbState::kTransit},
    {LimbState::kTransit, E::kDone, LimbState::kPregrasp},
    {LimbState::kPregrasp, E::kDone, LimbState::kApproach},
    {LimbState::kApproach, E::kDone, LimbState::kClosing},
    {LimbState::kClosing, E::kDone, LimbState::kVerify},
    {LimbState::kVerify, E::kDone, LimbState::kLoading},
    {LimbState::kLoading, E::kDone, LimbState::kLoaded},

    // No grasp: again, and then back to the rung that held before.
    {LimbState::kApproach, E::kMissed, LimbState::kRegrasp},
    {LimbState::kClosing, E::kMissed, LimbState::kRegrasp},
    {LimbState::kVerify, E::kMissed, LimbState::kRegrasp},
    {LimbState::kLoading, E::kLost, LimbState::kRegrasp},
    {LimbState::kRegrasp, E::kDone, LimbState::kPregrasp},
    {LimbState::kRegrasp, E::kGiveUp, LimbState::kAbortReturn},
    {LimbState::kAbortReturn, E::kDone, LimbState::kPregrasp},

    // Withdrawn: while the claw still holds, it is simply loaded again.
    {LimbState::kUnloading, E::kAbort, LimbState::kLoading},
    {LimbState::kReleasing, E::kAbort, LimbState::kClosing},
    {LimbState::kRegrasp, E::kAbort, LimbState::kClosing},  // needed, and not open yet
    {LimbState::kRetracting, E::kAbort, LimbState::kAbortReturn},
    {LimbState::kTransit, E::kAbort, LimbState::kAbortReturn},
    {LimbState::kPregrasp, E::kAbort, LimbState::kAbortReturn},
    {LimbState::kApproach, E::kAbort, LimbState::kAbortReturn},

    {LimbState::kLoaded, E::kLost, LimbState::kSupportLost},
    {LimbState::kUnloading, E::kLost, LimbState::kSupportLost},

    {LimbState::kRetracting, E::kPark, LimbState::kPregrasp},

    // Found closed when armed: pulled at before it counts, or there was nothing in it.
    {LimbState::kLoaded, E::kProve, LimbState::kVerify},
    {LimbState::kLoaded, E::kMissed, LimbState::kPregrasp},
};

}  // namespace

const char* name(LimbState state) {
  constexpr const char* kNames[kNumLimbStates] = {
      "LOADED",  "UNLOADING", "RELEASING", "RETRACTING", "TRANSIT",      "PREGRASP",    "APPROACH",
      "CLOSING", "VERIFY",    "LOADING",   "REGRASP",    "ABORT_RETURN", "SUPPORT_LOST"};
  return kNames[static_cast<int>(state)];
}

const char* name(LimbEvent event) {
  constexpr const char* kNames[kNumLimbEvents] = {"lift",    "done", "abort", "missed",
                                                  "give up", "lost", "prove", "park"};
  return kNames[static_cast<int>(event)];
}

std::span<const LimbTransition> limb_transitions() {
  return kTransitions;
}

std::optional<LimbState> after(LimbState state, LimbEvent event) {
  for (const LimbTransition& transition : kTransitions) {
    if (transition.from == state && transition.event == event) return transition.to;
  }
  return std::nullopt;
}

}  // namespace climb
