// SPDX-License-Identifier: BSD-3-Clause
// The drive state machine's two tables.
#include "can/cia402_states.h"

#include <gtest/gtest.h>

namespace can::cia402 {
namespace {

struct StateCase {
  int status_word;
  DriveState state;
};

// Statuswords as CiA 402 prints them, with every other bit set or not.
TEST(Cia402States, StatuswordTable) {
  const StateCase cases[] = {{0x0000, DriveState::kNotReadyToSwitchOn},
                             {0xFFB0, DriveState::kNotReadyToSwitchOn},
                             {0x0240, DriveState::kSwitchOnDisabled},
                             {0x0250, DriveState::kSwitchOnDisabled},
                             {0x0060, DriveState::kSwitchOnDisabled},
                             {0x0231, DriveState::kReadyToSwitchOn},
                             {0x0021, DriveState::kReadyToSwitchOn},
                             {0x0233, DriveState::kSwitchedOn},
                             {0x0023, DriveState::kSwitchedOn},
                             {0x0627, DriveState::kOperationEnabled},
                             {0x1637, DriveState::kOperationEnabled},
                             {0x0007, DriveState::kQuickStopActive},
                             {0x0217, DriveState::kQuickStopActive},
                             {0x020F, DriveState::kFaultReactionActive},
                             {0x002F, DriveState::kFaultReactionActive},
                             {0x0208, DriveState::kFault},
                             {0x0238, DriveState::kFault},
                             {0x0001, DriveState::kUnknown},
                             {0x0067, DriveState::kUnknown},
                             {0x0047, DriveState::kUnknown},
                             {0x0003, DriveState::kUnknown}};
  for (const StateCase& row : cases) {
    EXPECT_EQ(state_of(static_cast<std::uint16_t>(row.status_word)), row.state)
        << std::hex << row.status_word;
  }
}

// Only bits 0-3, 5 and 6 decide, and each of the 65536 words has exactly one state.
TEST(Cia402States, OtherBitsDoNotMatter) {
  for (int word = 0; word <= 0xFFFF; ++word) {
    ASSERT_EQ(state_of(static_cast<std::uint16_t>(word)),
              state_of(static_cast<std::uint16_t>(word & 0x6F)));
  }
}

/// CiA 402's transitions, as an ideal drive makes them (605Ah = 6).
DriveState next(DriveState state, int control) {
  if (state == DriveState::kFault || state == DriveState::kFaultReactionActive) return state;
  if ((control & 0x02) == 0) return DriveState::kSwitchOnDisabled;
  const bool has_power = has_torque(state);
  if ((control & 0x04) == 0) {
    return has_power ? DriveState::kQuickStopActive : DriveState::kSwitchOnDisabled;
  }
  if (state == DriveState::kQuickStopActive) {
    return (control & 0x0F) == 0x0F ? DriveState::kOperationEnabled : state;
  }
  switch (control & 0x0F) {
    case 0x06:
      return DriveState::kReadyToSwitchOn;
    case 0x07:
      return state == DriveState::kReadyToSwitchOn || state == DriveState::kOperationEnabled
                 ? DriveState::kSwitchedOn
                 : state;
    case 0x0F:
      return state == DriveState::kSwitchedOn ? DriveState::kOperationEnabled : state;
    default:
      return state;
  }
}

constexpr DriveState kOrdinary[] = {DriveState::kSwitchOnDisabled, DriveState::kReadyToSwitchOn,
                                    DriveState::kSwitchedOn, DriveState::kOperationEnabled,
                                    DriveState::kQuickStopActive};

DriveState walk(Goal goal, DriveState state, int num_steps) {
  for (int i = 0; i < num_steps; ++i) state = next(state, control_word(goal, state));
  return state;
}

// Every ordinary state reaches its goal within three frames and stays there.
TEST(Cia402States, WalkReachesItsGoal) {
  for (const DriveState from : kOrdinary) {
    for (int extra = 0; extra < 3; ++extra) {
      EXPECT_EQ(walk(Goal::kEnabled, from, 3 + extra), DriveState::kOperationEnabled);
      EXPECT_EQ(walk(Goal::kDisabled, from, 3 + extra), DriveState::kSwitchOnDisabled);
      EXPECT_EQ(walk(Goal::kNoTorque, from, 1 + extra), DriveState::kSwitchOnDisabled);
      EXPECT_EQ(walk(Goal::kKeep, from, 1 + extra), from);
      if (has_torque(from)) {
        EXPECT_EQ(walk(Goal::kQuickStop, from, 1 + extra), DriveState::kQuickStopActive);
      }
    }
  }
}

// On the way to enabled, quick stop or keeping, torque that is on is never switched off.
TEST(Cia402States, TorqueIsNotDroppedOnTheWay) {
  for (const Goal goal : {Goal::kKeep, Goal::kEnabled, Goal::kQuickStop}) {
    for (const DriveState from : kOrdinary) {
      if (!has_torque(from)) continue;
      DriveState state = from;
      for (int i = 0; i < 5; ++i) {
        state = next(state, control_word(goal, state));
        EXPECT_TRUE(has_torque(state));
      }
    }
  }
}

// The contract's words.
TEST(Cia402States, WordsOfTheContract) {
  EXPECT_EQ(control_word(Goal::kEnabled, DriveState::kSwitchOnDisabled), 0x06);
  EXPECT_EQ(control_word(Goal::kEnabled, DriveState::kReadyToSwitchOn), 0x07);
  EXPECT_EQ(control_word(Goal::kEnabled, DriveState::kSwitchedOn), 0x0F);
  EXPECT_EQ(control_word(Goal::kEnabled, DriveState::kOperationEnabled), 0x0F);
  EXPECT_EQ(control_word(Goal::kQuickStop, DriveState::kOperationEnabled), 0x0B);
}

// No word of the walk resets a fault; resetting is an edge: 80h only after a word without it.
TEST(Cia402States, FaultResetIsAnEdge) {
  for (int goal = 0; goal < kNumGoals; ++goal) {
    for (int state = 0; state < kNumDriveStates; ++state) {
      EXPECT_EQ(control_word(static_cast<Goal>(goal), static_cast<DriveState>(state)) & 0x80, 0);
    }
  }
  EXPECT_EQ(reset_control_word(0x0F), 0x80);
  EXPECT_EQ(reset_control_word(0x80), 0x00);
  EXPECT_EQ(reset_control_word(0x00), 0x80);
}

}  // namespace
}  // namespace can::cia402
