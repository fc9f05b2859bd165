// SPDX-License-Identifier: BSD-3-Clause
// The failsafe table: every combination of faults in every state, and what single rows promise.
#include "climb/failsafe.h"

#include <vector>

#include <gtest/gtest.h>

namespace climb {
namespace {

constexpr int kNumLow = 13;
constexpr int kNumHigh = kNumFaults - kNumLow;

/// By the table, row by row, as one would read it.
Action read_table(FaultFlags flags, ControllerState state) {
  Action action;
  for (const FailsafeRow& row : failsafe_table()) {
    if ((flags & flag(row.fault)) == 0) continue;
    const Reaction reaction = row.in(group_of(state));
    if (reaction > action.reaction) {
      action.reaction = reaction;
      action.reason = row.fault;
    }
    action.silent = action.silent || row.silent;
    action.close_claws =
        action.close_claws || (row.close_claws && group_of(state) != StateGroup::kUnpowered);
  }
  action.latched = action.reaction == Reaction::kFaultHold || action.reaction == Reaction::kEstop;
  return action;
}

Action both(const Action& high_rows, const Action& low_rows) {
  Action action = low_rows.reaction > high_rows.reaction ? low_rows : high_rows;
  action.silent = high_rows.silent || low_rows.silent;
  action.close_claws = high_rows.close_claws || low_rows.close_claws;
  return action;
}

// All 2^26 sets of faults in all 11 states give what reading the table row by row gives.
TEST(Failsafe, IsItsTableForEveryCombination) {
  std::vector<Action> first(std::size_t{1} << kNumLow);
  std::vector<Action> last(std::size_t{1} << kNumHigh);
  for (int number = 0; number < kNumControllerStates; ++number) {
    const auto state = static_cast<ControllerState>(number);
    for (FaultFlags flags = 0; flags < first.size(); ++flags) {
      first[flags] = read_table(flags, state);
    }
    for (FaultFlags flags = 0; flags < last.size(); ++flags) {
      last[flags] = read_table(flags << kNumLow, state);
    }
    std::int64_t num_wrong = 0;
    for (FaultFlags high = 0; high < last.size(); ++high) {
      for (FaultFlags low = 0; low < first.size(); ++low) {
        const Action action = failsafe(high << kNumLow | low, state);
        num_wrong += action == both(first[low], last[high]) ? 0 : 1;
      }
    }
    EXPECT_EQ(num_wrong, 0) << name(state);
  }
}

// A reaction has one reason, which is among the faults; no fault, no reaction; bits beyond the
// table mean nothing.
TEST(Failsafe, NamesOneReason) {
  for (int number = 0; number < kNumControllerStates; ++number) {
    const auto state = static_cast<ControllerState>(number);
    EXPECT_EQ(failsafe(0, state), Action());
    EXPECT_EQ(failsafe(~FaultFlags{0} << kNumFaults, state), Action());
    for (int one = 0; one < kNumFaults; ++one) {
      for (int other = 0; other < kNumFaults; ++other) {
        const FaultFlags flags = FaultFlags{1} << one | FaultFlags{1} << other;
        const Action action = failsafe(flags, state);
        EXPECT_EQ(action.reason == Fault::kNone, action.reaction == Reaction::kNothing);
        if (action.reason != Fault::kNone) {
          EXPECT_NE(flags & flag(action.reason), 0U);
        }
      }
    }
  }
}

// More faults never give a weaker reaction.
TEST(Failsafe, NeverWeakens) {
  for (int number = 0; number < kNumControllerStates; ++number) {
    const auto state = static_cast<ControllerState>(number);
    FaultFlags flags = 0;
    Reaction before = Reaction::kNothing;
    for (int fault = kNumFaults - 1; fault >= 0; --fault) {
      flags |= FaultFlags{1} << fault;
      EXPECT_GE(failsafe(flags, state).reaction, before);
      before = failsafe(flags, state).reaction;
    }
  }
}

// The E-stop and its lost line stop everything everywhere, with priority over every other reason.
TEST(Failsafe, StopsOnTheEstopInEveryState) {
  for (int number = 0; number < kNumControllerStates; ++number) {
    const auto state = static_cast<ControllerState>(number);
    const FaultFlags all = (FaultFlags{1} << kNumFaults) - 1;
    EXPECT_EQ(failsafe(all, state).reaction, Reaction::kEstop);
    EXPECT_EQ(failsafe(all, state).reason, Fault::kEstop);
    EXPECT_EQ(failsafe(all & ~flag(Fault::kEstop), state).reason, Fault::kLinesLost);
  }
}

// While climbing no fault goes without reaction, and each the contract calls latched is latched;
// only perception lets it go on by itself.
TEST(Failsafe, ReactsToEveryFaultWhileClimbing) {
  for (const FailsafeRow& row : failsafe_table()) {
    const Action action = failsafe(flag(row.fault), ControllerState::kClimbing);
    EXPECT_GE(action.reaction, Reaction::kFinishStep) << row.name;
    EXPECT_EQ(action.reason, row.fault);
    const bool expects_latch = row.fault != Fault::kPerceptionSilent &&
                               row.fault != Fault::kTerminate && row.fault != Fault::kServoWarning;
    EXPECT_EQ(action.latched, expects_latch) << row.name;
    EXPECT_EQ(failsafe(flag(row.fault), ControllerState::kPaused), action);
    EXPECT_EQ(failsafe(flag(row.fault), ControllerState::kProtectiveHold), action);
  }
}

// On a bus that is down, stalled or shared nothing is sent, in any state.
TEST(Failsafe, SilencesTheBus) {
  const FaultFlags silencing =
      flag(Fault::kBusDown) | flag(Fault::kTransmitStalled) | flag(Fault::kSecondController);
  for (int number = 0; number < kNumControllerStates; ++number) {
    for (const FailsafeRow& row : failsafe_table()) {
      EXPECT_EQ(failsafe(flag(row.fault), static_cast<ControllerState>(number)).silent,
                (flag(row.fault) & silencing) != 0);
    }
  }
}

// Whoever falls or loses a stance closes its claws, unless it has no power.
TEST(Failsafe, ClosesTheClawsInAFall) {
  EXPECT_TRUE(failsafe(flag(Fault::kFreeFall), ControllerState::kClimbing).close_claws);
  EXPECT_TRUE(failsafe(flag(Fault::kFreeFall), ControllerState::kFaultHold).close_claws);
  EXPECT_FALSE(failsafe(flag(Fault::kFreeFall), ControllerState::kDisarmed).close_claws);
  EXPECT_FALSE(failsafe(flag(Fault::kServoFault), ControllerState::kClimbing).close_claws);
}

// What latches while standing also forbids the reset as long as it lasts.
TEST(Failsafe, ForbidsResetWhileTheCauseIsThere) {
  for (const FailsafeRow& row : failsafe_table()) {
    EXPECT_EQ((forbidding_reset() & flag(row.fault)) != 0,
              failsafe(flag(row.fault), ControllerState::kHold).latched);
  }
}

}  // namespace
}  // namespace climb
