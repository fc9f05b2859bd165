// SPDX-License-Identifier: BSD-3-Clause
// What the controller does not do: lift or release on an infirm stance, follow targets hanging on
// two claws, send what the gate refused, forget why it stopped.
#include <gtest/gtest.h>

#include "tests/climb/controller_fixture.h"

namespace climb {
namespace {

using climb_tests::kSession;
using climb_tests::params;
using S = ControllerState;

class RefusalsTest : public climb_tests::ControllerFixture {};

// Touch of a stance claw is open in one cycle of a few, too briefly for a loss: the limb is lifted
// after and released in a cycle in which all others hold, never in another.
TEST_F(RefusalsTest, LiftsAndReleasesOnAFirmStanceOnly) {
  constexpr int kPeriod = 7;  // no divisor of the time between: some phase is open at the release
  for (int phase = 0; phase < kPeriod; ++phase) {
    start_anew();
    ASSERT_TRUE(arm()) << where();
    bool touched_before = true;
    bool is_released = false;
    for (int i = 0; i < 2000 && !is_released; ++i) {
      const LimbState before = output_.limbs[kRearRight];
      const bool touches = (i + phase) % kPeriod != 0;
      stand_.input.touch[kFrontLeft] = touches;
      if (i == 0) stand_.input.command = {Order::kClimb, kSession, ++seq_};
      cycle();
      const LimbState now = output_.limbs[kRearRight];
      if (before == LimbState::kLoaded && now == LimbState::kUnloading) {
        EXPECT_TRUE(touched_before) << "lifted, phase " << phase;
      }
      is_released = before == LimbState::kUnloading && now == LimbState::kReleasing;
      if (is_released) {
        EXPECT_TRUE(touches) << "released, phase " << phase;
      }
      touched_before = touches;
    }
    EXPECT_TRUE(is_released) << where();
  }
}

// Stopped on the ladder, and two claws have opened meanwhile: it is not armed, people must help.
TEST_F(RefusalsTest, IsNotArmedHangingOnTwoClaws) {
  ASSERT_TRUE(arm()) << where();
  stand_.input.faults = flag(Fault::kServoFault);
  run(1.0);
  stand_.input.faults = 0;
  order(Order::kReset);
  ASSERT_EQ(output_.state, S::kDisarmed) << where();
  for (int i = 0; i < 200; ++i) {
    for (const Leg leg : {kFrontLeft, kFrontRight}) {
      stand_.input.axes[axis_of(leg, kJaw)].position_rad = 0.5;
    }
    if (i == 50) stand_.input.command = {Order::kArm, kSession, ++seq_};
    cycle();
    ASSERT_FALSE(output_.send) << "cycle " << i;
  }
  EXPECT_EQ(output_.state, S::kDisarmed) << where();
}

// The gate refuses a jaw that is to move faster than it can: a fault of ours, told as such.
TEST_F(RefusalsTest, ARefusedCommandIsAFault) {
  ControllerParams hasty = params();
  hasty.limb.jaw_speed_rad_s = 50.0;
  controller_ = Controller(hasty);
  ASSERT_TRUE(reach(S::kDisarmed, 1.0));
  order(Order::kArm);
  ASSERT_TRUE(reach(S::kFaultHold, 60.0)) << where();
  EXPECT_EQ(output_.reason, Fault::kUnsafeCommand);
}

// In ESTOP the first reason stays, also when the lines are lost after the button was released.
TEST_F(RefusalsTest, TheFirstReasonStays) {
  ASSERT_TRUE(arm()) << where();
  stand_.input.estop_clear = false;
  cycle();
  ASSERT_EQ(output_.state, S::kEstop);
  stand_.input.estop_clear = true;
  stand_.input.faults = flag(Fault::kLinesLost);
  run(0.2);
  EXPECT_EQ(output_.state, S::kEstop);
  EXPECT_EQ(output_.reason, Fault::kEstop);
}

}  // namespace
}  // namespace climb
