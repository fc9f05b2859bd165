// SPDX-License-Identifier: BSD-3-Clause
#include "climb/controller_state.h"

namespace climb {

using S = ControllerState;

namespace {

using E = ControllerEvent;

constexpr ControllerTransition kTransitions[] = {
    {S::kBoot, E::kBooted, S::kSelftest},
    {S::kSelftest, E::kSelftestPassed, S::kDisarmed},
    {S::kDisarmed, E::kArm, S::kArming},
    {S::kArming, E::kArmed, S::kHold},
    {S::kArming, E::kArmingRefused, S::kDisarmed},

    {S::kHold, E::kClimb, S::kClimbing},
    {S::kClimbing, E::kHold, S::kHold},
    {S::kClimbing, E::kPause, S::kPaused},
    {S::kPaused, E::kClimb, S::kClimbing},
    {S::kPaused, E::kHold, S::kHold},
    {S::kClimbing, E::kProtect, S::kProtectiveHold},
    {S::kProtectiveHold, E::kRecovered, S::kClimbing},
    {S::kProtectiveHold, E::kPause, S::kPaused},
    {S::kProtectiveHold, E::kHold, S::kHold},

    {S::kArming, E::kFault, S::kFaultHold},
    {S::kHold, E::kFault, S::kFaultHold},
    {S::kClimbing, E::kFault, S::kFaultHold},
    {S::kPaused, E::kFault, S::kFaultHold},
    {S::kProtectiveHold, E::kFault, S::kFaultHold},
    {S::kDisarming, E::kFault, S::kFaultHold},

    {S::kBoot, E::kEstop, S::kEstop},
    {S::kSelftest, E::kEstop, S::kEstop},
    {S::kDisarmed, E::kEstop, S::kEstop},
    {S::kArming, E::kEstop, S::kEstop},
    {S::kHold, E::kEstop, S::kEstop},
    {S::kClimbing, E::kEstop, S::kEstop},
    {S::kPaused, E::kEstop, S::kEstop},
    {S::kProtectiveHold, E::kEstop, S::kEstop},
    {S::kFaultHold, E::kEstop, S::kEstop},
    {S::kDisarming, E::kEstop, S::kEstop},

    {S::kFaultHold, E::kReset, S::kDisarmed},
    {S::kEstop, E::kReset, S::kDisarmed},
    {S::kHold, E::kDisarm, S::kDisarming},
    {S::kDisarming, E::kDisarmed, S::kDisarmed},
    {S::kDisarming, E::kHold, S::kHold},  // the dock does not carry it: no claw was opened
};

}  // namespace

const char* name(ControllerState state) {
  constexpr const char* kNames[kNumControllerStates] = {
      "BOOT",   "SELFTEST",        "DISARMED",   "ARMING", "HOLD",     "CLIMBING",
      "PAUSED", "PROTECTIVE_HOLD", "FAULT_HOLD", "ESTOP",  "DISARMING"};
  return kNames[static_cast<int>(state)];
}

const char* name(ControllerEvent event) {
  constexpr const char* kNames[kNumControllerEvents] = {
      "booted",  "selftest passed", "arm",   "armed", "arming refused", "climb",  "pause",   "hold",
      "protect", "recovered",       "fault", "estop", "reset",          "disarm", "disarmed"};
  return kNames[static_cast<int>(event)];
}

std::span<const ControllerTransition> controller_transitions() {
  return kTransitions;
}

std::optional<ControllerState> after(ControllerState state, ControllerEvent event) {
  for (const ControllerTransition& transition : kTransitions) {
    if (transition.from == state && transition.event == event) return transition.to;
  }
  return std::nullopt;
}

}  // namespace climb
