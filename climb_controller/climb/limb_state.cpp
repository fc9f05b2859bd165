// SPDX-License-Identifier: BSD-3-Clause
#include "climb/limb_state.h"

namespace climb {
namespace {

using S = LimbState;
using E = LimbEvent;

constexpr LimbTransition kTransitions[] = {
    {S::kLoaded, E::kLift, S::kUnloading},
    {S::kUnloading, E::kDone, S::kReleasing},
    {S::kReleasing, E::kDone, S::kRetracting},
    {S::kRetracting, E::kDone, S::kTransit},
    {S::kTransit, E::kDone, S::kPregrasp},
    {S::kPregrasp, E::kDone, S::kApproach},
    {S::kApproach, E::kDone, S::kClosing},
    {S::kClosing, E::kDone, S::kVerify},
    {S::kVerify, E::kDone, S::kLoading},
    {S::kLoading, E::kDone, S::kLoaded},

    // No grasp: again, and then back to the rung that held before.
    {S::kApproach, E::kMissed, S::kRegrasp},
    {S::kClosing, E::kMissed, S::kRegrasp},
    {S::kVerify, E::kMissed, S::kRegrasp},
    {S::kLoading, E::kLost, S::kRegrasp},
    {S::kRegrasp, E::kDone, S::kPregrasp},
    {S::kRegrasp, E::kGiveUp, S::kAbortReturn},
    {S::kAbortReturn, E::kDone, S::kPregrasp},

    // Withdrawn: while the claw still holds, it is simply loaded again.
    {S::kUnloading, E::kAbort, S::kLoading},
    {S::kReleasing, E::kAbort, S::kClosing},
    {S::kRegrasp, E::kAbort, S::kClosing},  // needed, and not open yet
    {S::kRetracting, E::kAbort, S::kAbortReturn},
    {S::kTransit, E::kAbort, S::kAbortReturn},
    {S::kPregrasp, E::kAbort, S::kAbortReturn},
    {S::kApproach, E::kAbort, S::kAbortReturn},

    {S::kLoaded, E::kLost, S::kSupportLost},
    {S::kUnloading, E::kLost, S::kSupportLost},

    {S::kRetracting, E::kPark, S::kPregrasp},

    // Found closed when armed: pulled at before it counts, or there was nothing in it.
    {S::kLoaded, E::kProve, S::kVerify},
    {S::kLoaded, E::kMissed, S::kPregrasp},
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
