// SPDX-License-Identifier: BSD-3-Clause
// What the controller finds in its own input: each fault at its bound, and not before.
#include "climb/fault_watch.h"

#include <cmath>

#include <gtest/gtest.h>

namespace climb {
namespace {

constexpr int kHip = 1;

class FaultWatchTest : public testing::Test {
 protected:
  FaultWatchTest() {
    input_.now_us = 1'000'000;
    input_.ladder_received_us = 1'000'000;
    input_.estop_clear = true;
    input_.imu.valid = true;
    for (AxisReading& axis : input_.axes) axis = {0.5, 0.0, true};
    for (AxisCommand& command : sent_) command.position_rad = 0.5;
    watch_.arm(input_);
  }
  FaultFlags look() { return watch_.look(input_, sent_); }
  void turn(double degrees) {
    const double half_rad = degrees * 3.14159265358979 / 360.0;
    input_.imu.q_odom_body = {std::cos(half_rad), 0.0, std::sin(half_rad), 0.0};
  }

  ControllerInput input_;
  PerAxis<AxisCommand> sent_{};
  FaultWatch watch_{axis_limits(RobotParams()), WatchParams()};
};

// Nothing is wrong: nothing is found.
TEST_F(FaultWatchTest, FindsNothing) {
  for (int i = 0; i < 100; ++i) EXPECT_EQ(look(), 0U);
}

// A joint 0.3 rad behind its target for two cycles in a row, one cycle is forgiven.
TEST_F(FaultWatchTest, FindsWhatDoesNotFollow) {
  sent_[kHip].position_rad = 0.81;
  EXPECT_EQ(look(), 0U);
  sent_[kHip].position_rad = 0.79;
  EXPECT_EQ(look(), 0U);
  sent_[kHip].position_rad = 0.81;
  EXPECT_EQ(look(), 0U);
  EXPECT_EQ(look(), flag(Fault::kTracking));
}

// A joint that is elsewhere than it can have come in a cycle, although that is where it should be.
TEST_F(FaultWatchTest, FindsJumps) {
  input_.axes[kHip].position_rad = sent_[kHip].position_rad = 0.57;
  EXPECT_EQ(look(), 0U);
  input_.axes[kHip].position_rad = sent_[kHip].position_rad = 0.65;
  EXPECT_EQ(look(), flag(Fault::kTracking));
}

// Weightless for 50 ms without a break.
TEST_F(FaultWatchTest, FindsFreeFall) {
  input_.imu.acceleration_m_s2 = 2.0;
  for (int i = 0; i < 4; ++i) EXPECT_EQ(look(), 0U);
  input_.imu.acceleration_m_s2 = 9.8;
  EXPECT_EQ(look(), 0U);
  input_.imu.acceleration_m_s2 = 2.0;
  for (int i = 0; i < 4; ++i) EXPECT_EQ(look(), 0U);
  EXPECT_EQ(look(), flag(Fault::kFreeFall));
}

// 15 degrees off the attitude it was armed in.
TEST_F(FaultWatchTest, FindsTilt) {
  turn(14.0);
  EXPECT_EQ(look(), 0U);
  turn(16.0);
  EXPECT_EQ(look(), flag(Fault::kTilt));
  watch_.disarm();
  EXPECT_EQ(look(), 0U);
}

// An axis that was not heard, an IMU that was not, rungs that are too old or of the future.
TEST_F(FaultWatchTest, FindsSilence) {
  input_.axes[kHip].valid = false;
  EXPECT_EQ(look(), flag(Fault::kServoSilent));
  input_.axes[kHip].valid = true;
  input_.imu.valid = false;
  EXPECT_EQ(look(), flag(Fault::kImuSilent));
  input_.imu.valid = true;
  for (const std::int64_t age_us : {300'001, -1}) {
    input_.ladder_received_us = input_.now_us - age_us;
    EXPECT_EQ(look(), flag(Fault::kPerceptionSilent)) << age_us;
  }
  input_.ladder_received_us = input_.now_us - 300'000;
  EXPECT_EQ(look(), 0U);
}

}  // namespace
}  // namespace climb
