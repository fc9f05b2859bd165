// SPDX-License-Identifier: BSD-3-Clause
#include "climb/failsafe.h"

#include <array>
#include <bit>

namespace climb {
namespace {

using F = Fault;

// In FAULT_HOLD and ESTOP only an E-stop still changes anything: the first reason stays.
constexpr std::array<FailsafeRow, kNumFaults> make_table() {
  constexpr Reaction none = Reaction::kNothing;
  constexpr Reaction block = Reaction::kBlock;
  constexpr Reaction step = Reaction::kFinishStep;
  constexpr Reaction prot = Reaction::kProtectiveHold;
  constexpr Reaction hold = Reaction::kFaultHold;
  constexpr Reaction stop = Reaction::kEstop;
  // clang-format off
  return {{
    // fault                name                    unpowered arming standing climbing latched  silent close claws
    {F::kEstop,            "E-stop",                 stop,  stop,  stop,  stop,  stop,          false, false},
    {F::kLinesLost,        "lines lost",             stop,  stop,  stop,  stop,  stop,          false, false},
    {F::kFreeFall,         "free fall",              block, hold,  hold,  hold,  none,          false, true},
    {F::kTooFewGrasps,     "too few grasps",         none,  none,  hold,  hold,  none,          false, true},
    {F::kBusDown,          "bus down",               block, hold,  hold,  hold,  none,          true,  false},
    {F::kTransmitStalled,  "transmit stalled",       block, hold,  hold,  hold,  none,          true,  false},
    {F::kSecondController, "second controller",      block, hold,  hold,  hold,  none,          true,  false},
    {F::kServoFault,       "servo fault",            block, hold,  hold,  hold,  none,          false, false},
    {F::kServoSilent,      "servo silent",           block, hold,  hold,  hold,  none,          false, false},
    {F::kServoState,       "servo state",            block, hold,  hold,  hold,  none,          false, false},
    {F::kHeartbeatLost,    "servo heartbeat lost",   block, hold,  hold,  hold,  none,          false, false},
    {F::kTracking,         "tracking",               block, hold,  hold,  hold,  none,          false, false},
    {F::kMalformedFrames,  "malformed frames",       block, hold,  hold,  hold,  none,          false, false},
    {F::kUnsafeCommand,    "unsafe command",         block, hold,  hold,  hold,  none,          false, false},
    {F::kOverrun,          "overrun",                block, hold,  hold,  hold,  none,          false, false},
    {F::kSuspended,        "suspended",              block, hold,  hold,  hold,  none,          false, false},
    {F::kTilt,             "tilt",                   block, hold,  hold,  hold,  none,          false, false},
    {F::kImuSilent,        "IMU silent",             block, hold,  hold,  hold,  none,          false, false},
    {F::kTouchStuck,       "touch stuck",            block, hold,  hold,  hold,  none,          false, false},
    {F::kGraspDisagrees,   "grasp disagrees",        none,  hold,  hold,  hold,  none,          false, false},
    {F::kStanceLost,       "stance lost",            none,  hold,  hold,  hold,  none,          false, true},
    {F::kNoGrasp,          "no grasp",               none,  hold,  hold,  hold,  none,          false, false},
    {F::kConfiguration,    "configuration",          block, block, hold,  hold,  none,          false, false},
    {F::kTerminate,        "terminate",              block, block, none,  step,  none,          false, false},
    {F::kServoWarning,     "servo warning",          block, block, none,  step,  none,          false, false},
    {F::kPerceptionSilent, "perception silent",      none,  none,  none,  prot,  none,          false, false},
  }};
  // clang-format on
}

constexpr std::array<FailsafeRow, kNumFaults> kTable = make_table();

constexpr StateGroup kGroups[kNumControllerStates] = {
    StateGroup::kUnpowered,  // BOOT
    StateGroup::kUnpowered,  // SELFTEST
    StateGroup::kUnpowered,  // DISARMED
    StateGroup::kArming,     // ARMING
    StateGroup::kStanding,   // HOLD
    StateGroup::kClimbing,   // CLIMBING
    StateGroup::kClimbing,   // PAUSED: it may be paused in the middle of a step
    StateGroup::kClimbing,   // PROTECTIVE_HOLD
    StateGroup::kLatched,    // FAULT_HOLD
    StateGroup::kLatched,    // ESTOP
    StateGroup::kStanding,   // DISARMING
};

constexpr bool rows_in_order() {
  for (int i = 0; i < kNumFaults; ++i) {
    if (static_cast<int>(kTable[i].fault) != i) return false;
  }
  return true;
}
static_assert(rows_in_order(), "a fault is its row's number");

/// Which faults call for which reaction, column by column: the table turned for look-up.
struct Masks {
  FaultFlags faults[kNumStateGroups][kNumReactions]{};
  FaultFlags silent = 0;
  FaultFlags close_claws = 0;
};

constexpr Masks masks_of_table() {
  Masks masks;
  for (const FailsafeRow& row : kTable) {
    for (int group = 0; group < kNumStateGroups; ++group) {
      const Reaction reaction = row.in(static_cast<StateGroup>(group));
      masks.faults[group][static_cast<int>(reaction)] |= flag(row.fault);
    }
    if (row.silent) masks.silent |= flag(row.fault);
    if (row.close_claws) masks.close_claws |= flag(row.fault);
  }
  return masks;
}
constexpr Masks kMasks = masks_of_table();

}  // namespace

const char* name(Fault fault) {
  return fault == Fault::kNone ? "none" : kTable[static_cast<int>(fault)].name;
}

const char* name(Reaction reaction) {
  constexpr const char* kNames[kNumReactions] = {"nothing",         "block",      "finish step",
                                                 "protective hold", "fault hold", "E-stop"};
  return kNames[static_cast<int>(reaction)];
}

StateGroup group_of(ControllerState state) {
  return kGroups[static_cast<int>(state)];
}

std::span<const FailsafeRow> failsafe_table() {
  return kTable;
}

Action failsafe(FaultFlags flags, ControllerState state) {
  const auto& column = kMasks.faults[static_cast<int>(group_of(state))];
  Action action;
  for (int reaction = kNumReactions - 1; reaction > 0; --reaction) {
    const FaultFlags causes = flags & column[reaction];
    if (causes == 0) continue;
    action.reaction = static_cast<Reaction>(reaction);
    action.reason = static_cast<Fault>(std::countr_zero(causes));
    break;
  }
  action.latched = action.reaction >= Reaction::kFaultHold;
  // Whatever else happens: a bus that is down or not ours alone is not spoken on, and who falls
  // grips.
  action.silent = (flags & kMasks.silent) != 0;
  action.close_claws =
      (flags & kMasks.close_claws) != 0 && group_of(state) != StateGroup::kUnpowered;
  return action;
}

FaultFlags forbidding_reset() {
  const auto& standing = kMasks.faults[static_cast<int>(StateGroup::kStanding)];
  return standing[static_cast<int>(Reaction::kFaultHold)] |
         standing[static_cast<int>(Reaction::kEstop)];
}

}  // namespace climb
