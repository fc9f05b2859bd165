// SPDX-License-Identifier: BSD-3-Clause
// The two transition tables: every pair of state and event that is not in them is refused.
#include <set>
#include <tuple>

#include <gtest/gtest.h>

#include "climb/controller_state.h"
#include "climb/limb_state.h"

namespace climb {
namespace {

template <typename State, typename Event, typename Table>
void expect_only_the_table(const Table& table, int num_states, int num_events) {
  std::set<std::pair<State, Event>> listed;
  for (const auto& transition : table) {
    EXPECT_TRUE(listed.insert({transition.from, transition.event}).second)
        << "listed twice: " << name(transition.from) << " + " << name(transition.event);
    EXPECT_EQ(after(transition.from, transition.event), transition.to);
  }
  for (int s = 0; s < num_states; ++s) {
    for (int e = 0; e < num_events; ++e) {
      const auto state = static_cast<State>(s);
      const auto event = static_cast<Event>(e);
      EXPECT_EQ(after(state, event).has_value(), listed.count({state, event}) == 1)
          << name(state) << " + " << name(event);
    }
  }
}

// What is not in the table is refused, nothing is in it twice: 11 x 15 and 13 x 7 pairs.
TEST(ControlStates, RefuseWhatTheTableDoesNotList) {
  expect_only_the_table<ControllerState, ControllerEvent>(
      controller_transitions(), kNumControllerStates, kNumControllerEvents);
  expect_only_the_table<LimbState, LimbEvent>(limb_transitions(), kNumLimbStates, kNumLimbEvents);
}

// The latched states are left by a reset only (FAULT_HOLD also into ESTOP), and never into motion.
TEST(ControlStates, LatchedStatesLeaveByResetOnly) {
  for (int e = 0; e < kNumControllerEvents; ++e) {
    const auto event = static_cast<ControllerEvent>(e);
    const auto from_fault = after(ControllerState::kFaultHold, event);
    const auto from_estop = after(ControllerState::kEstop, event);
    if (event == ControllerEvent::kReset) {
      EXPECT_EQ(from_fault, ControllerState::kDisarmed);
      EXPECT_EQ(from_estop, ControllerState::kDisarmed);
    } else {
      EXPECT_FALSE(from_estop.has_value()) << name(event);
      EXPECT_EQ(from_fault.has_value(), event == ControllerEvent::kEstop) << name(event);
    }
  }
}

// CLIMBING is reached from HOLD, PAUSED and PROTECTIVE_HOLD only; HOLD from an unpowered state only
// by way of ARMING; torque is walked down from HOLD only.
TEST(ControlStates, MotionNeedsArming) {
  for (const ControllerTransition& way : controller_transitions()) {
    if (way.to == ControllerState::kClimbing) {
      EXPECT_TRUE(is_powered(way.from));
    }
    if (is_powered(way.to) && !is_powered(way.from)) {
      // ... or from DISARMING in the dock, before a claw was opened.
      const bool keeps_power =
          way.from == ControllerState::kDisarming && way.to == ControllerState::kHold;
      EXPECT_TRUE(way.from == ControllerState::kArming || keeps_power);
    }
    if (way.to == ControllerState::kDisarming) {
      EXPECT_EQ(way.from, ControllerState::kHold);
    }
  }
}

// Every state but the E-stop's own has a way into ESTOP.
TEST(ControlStates, EveryStateCanStop) {
  for (int s = 0; s < kNumControllerStates; ++s) {
    const auto state = static_cast<ControllerState>(s);
    EXPECT_EQ(after(state, ControllerEvent::kEstop).has_value(), state != ControllerState::kEstop);
  }
}

// LOADED is reached only through VERIFY and LOADING, or by loading again what was never opened.
TEST(ControlStates, ALimbIsLoadedOnlyAfterVerification) {
  for (const LimbTransition& way : limb_transitions()) {
    if (way.to == LimbState::kLoaded) {
      EXPECT_EQ(way.from, LimbState::kLoading);
    }
    if (way.to == LimbState::kLoading) {
      EXPECT_TRUE(way.from == LimbState::kVerify || way.from == LimbState::kUnloading);
    }
    if (way.to == LimbState::kReleasing) {
      EXPECT_EQ(way.from, LimbState::kUnloading);
    }
  }
}

}  // namespace
}  // namespace climb
