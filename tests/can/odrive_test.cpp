// SPDX-License-Identifier: BSD-3-Clause
// ODrive's CANSimple: frames as hex, round trips, and the bus against a scripted motor.
#include "can/odrive.h"

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "can/odrive_bus.h"
#include "fake_line.h"
#include "odrive_motor.h"
#include "random_messages.h"

namespace can {
namespace {

// Frames as ODrive's own DBC encodes them.
TEST(OdriveCodec, FramesAsHex) {
  EXPECT_EQ(hex(*encode(odrive::InputPos{0, 1.5F, 250, -100})), "00C#0000C03FFA009CFF");
  EXPECT_EQ(hex(encode(odrive::SetAxisState{3, odrive::AxisState::kClosedLoopControl})),
            "067#08000000");
  EXPECT_EQ(hex(encode(odrive::ControllerMode{1})), "02B#0300000001000000");
  EXPECT_EQ(hex(*encode(odrive::Limits{1, 2.0F, 10.0F})), "02F#0000004000002041");
  EXPECT_EQ(hex(*encode(odrive::EncoderEstimates{63, -1.0F, 0.5F})), "7E9#000080BF0000003F");
  EXPECT_EQ(hex(encode(odrive::Heartbeat{2, 0x40, 8, {1, 0, 0x80}})), "041#4000000008010080");
  EXPECT_EQ(hex(odrive::encode_estop(2)), "042#");
  EXPECT_EQ(hex(odrive::encode_clear_errors(2)), "058#");
}

// A million random messages come back bit for bit.
TEST(OdriveCodec, MillionRoundTrips) {
  base::Rng rng(5);
  for (int i = 0; i < 350'000; ++i) {
    const auto node = static_cast<std::uint8_t>(rng.below(64));
    const odrive::InputPos input{node, any_float(rng), any<std::int16_t>(rng),
                                 any<std::int16_t>(rng)};
    const auto input_again = odrive::decode_input_pos(*encode(input));
    ASSERT_TRUE(input_again && input_again->node == node &&
                input_again->position_rev == input.position_rev &&
                input_again->velocity_milli_rev_s == input.velocity_milli_rev_s &&
                input_again->torque_mNm == input.torque_mNm);
    const odrive::EncoderEstimates estimates{node, any_float(rng), any_float(rng)};
    const auto estimates_again = odrive::decode_encoder_estimates(*encode(estimates));
    ASSERT_TRUE(estimates_again && estimates_again->position_rev == estimates.position_rev &&
                estimates_again->velocity_rev_s == estimates.velocity_rev_s);
    const odrive::Heartbeat heartbeat{
        node, any<std::uint32_t>(rng), any<std::uint8_t>(rng), {1, 2, any<std::uint8_t>(rng)}};
    const auto heartbeat_again = odrive::decode_heartbeat(encode(heartbeat));
    ASSERT_TRUE(heartbeat_again && heartbeat_again->axis_error == heartbeat.axis_error &&
                heartbeat_again->axis_state == heartbeat.axis_state &&
                heartbeat_again->flags[2] == heartbeat.flags[2]);
  }
}

// Floats that are not finite are neither sent nor believed; odd frames mean nothing.
TEST(OdriveCodec, OddInputs) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(encode(odrive::InputPos{1, nan, 0, 0}));
  EXPECT_FALSE(encode(odrive::Limits{1, infinity, 0}));
  EXPECT_FALSE(odrive::decode_encoder_estimates(from_hex("029#0000C07F00000000")));
  EXPECT_FALSE(odrive::decode_encoder_estimates(from_hex("029#00000000000080FF")));
  for (int dlc = 0; dlc < 8; ++dlc) {
    CanFrame frame = from_hex("021#0000000008000000");
    frame.dlc = static_cast<std::uint8_t>(dlc);
    EXPECT_FALSE(odrive::decode_heartbeat(frame)) << dlc;
  }
  CanFrame remote = from_hex("021#0000000008000000");
  remote.remote = true;
  EXPECT_FALSE(odrive::decode_heartbeat(remote));
}

class OdriveRig {
 public:
  OdriveRig() {
    OdriveParams params;
    AxisConfig axis;
    axis.node_id = 1;
    axis.gear = 6.283185307179586;  // one revolution of the motor per radian of the joint
    params.axes = {axis};
    bus = std::make_unique<OdriveBus>(params, line);
  }
  void run_ms(int duration_ms) {
    for (int i = 0; i < duration_ms / 10; ++i) {
      bus->exchange(time_ms * 1000, {time_ms * 1000, {&target, 1}}, {&feedback, 1});
      for (int j = 0; j < 10; ++j) {
        for (; num_delivered < line.sent.size(); ++num_delivered) {
          motor.hear(line.sent[num_delivered]);
        }
        motor.speak(line, ++time_ms);
      }
    }
  }
  bool bring_to_ready() {
    target.position_rad = 1.0;
    run_ms(10);
    bus->configure();
    run_ms(600);
    return bus->phase() == BusPhase::kReady;
  }
  bool bring_to_enabled() {
    if (!bring_to_ready() || !bus->enable()) return false;
    run_ms(300);
    return bus->phase() == BusPhase::kEnabled;
  }
  FakeLine line;
  OdriveMotor motor;
  std::unique_ptr<OdriveBus> bus;
  AxisTarget target;
  AxisFeedback feedback;
  std::int64_t time_ms = 1000;
  std::size_t num_delivered = 0;
};

// From power-up to following targets; holding on loss of the master is not claimed.
TEST(OdriveBus, ComesUpAndFollows) {
  OdriveRig rig;
  ASSERT_TRUE(rig.bring_to_enabled());
  EXPECT_EQ(rig.motor.first_target, "0000803F");  // measured
  EXPECT_FALSE(rig.bus->capabilities().hold_on_loss);
  EXPECT_FALSE(rig.bus->capabilities().sync);
  rig.target.position_rad = 2.0;
  rig.run_ms(50);
  EXPECT_EQ(rig.motor.estimates, "00000040");
  EXPECT_NEAR(rig.feedback.position_rad, 2.0, 1e-6);
  EXPECT_EQ(rig.feedback.state, DriveState::kOperationEnabled);
  rig.bus->disable();
  rig.run_ms(300);
  EXPECT_EQ(rig.motor.state, 1);
  EXPECT_EQ(rig.bus->phase(), BusPhase::kReady);
  EXPECT_TRUE(rig.bus->faults().empty());
}

// Disarmed, failed, silent, refused: each is told; a motor is never armed again by itself.
TEST(OdriveBus, Faults) {
  const auto cause_after = [](auto harm) {
    OdriveRig rig;
    EXPECT_TRUE(rig.bring_to_enabled());
    harm(rig);
    rig.run_ms(400);
    EXPECT_FALSE(rig.bus->enable());
    return rig.bus->faults().empty() ? std::string("none") : name(rig.bus->faults()[0].cause);
  };
  EXPECT_EQ(cause_after([](OdriveRig& rig) { rig.motor.state = 1; }), "left operation enabled");
  EXPECT_EQ(cause_after([](OdriveRig& rig) { rig.motor.error = 0x40; }), "emergency");
  EXPECT_EQ(cause_after([](OdriveRig& rig) { rig.motor.is_silent = true; }), "silent");
  EXPECT_EQ(cause_after([](OdriveRig& rig) { rig.line.put(from_hex("02C#0000000000000000")); }),
            "foreign master");
  EXPECT_EQ(cause_after([](OdriveRig& rig) {
              rig.target.position_rad = std::numeric_limits<double>::quiet_NaN();
            }),
            "target refused");
  EXPECT_EQ(cause_after([](OdriveRig& rig) { rig.line.send_status = TransferStatus::kNoBuffers; }),
            "transmit stalled");
}

// After a pause of ours a motor may have disarmed itself and the limb may hang elsewhere: before
// its heartbeat has said its state anew it gets no new target.
TEST(OdriveBus, PauseIsNotFollowedByNewTargets) {
  OdriveRig rig;
  ASSERT_TRUE(rig.bring_to_enabled());
  while (rig.time_ms % 100 != 0) rig.run_ms(10);
  rig.time_ms += 210;
  rig.target.position_rad = 2.0;
  rig.run_ms(80);
  EXPECT_EQ(rig.motor.estimates, "0000803F");
  rig.run_ms(40);
  EXPECT_EQ(rig.motor.estimates, "00000040");
}

// The same while motors are being armed: none is armed on its word from before.
TEST(OdriveBus, PauseEndsArmingUntilTheMotorSpeaks) {
  OdriveRig rig;
  ASSERT_TRUE(rig.bring_to_ready());
  while (rig.time_ms % 100 != 0) rig.run_ms(10);
  ASSERT_TRUE(rig.bus->enable());
  rig.time_ms += 210;
  rig.run_ms(80);
  EXPECT_EQ(rig.motor.state, 1);
  rig.run_ms(200);
  EXPECT_EQ(rig.motor.state, 8);
  EXPECT_EQ(rig.bus->phase(), BusPhase::kEnabled);
}

// After an error: rearm() clears it, and arming waits for enable().
TEST(OdriveBus, RearmDoesNotArm) {
  OdriveRig rig;
  ASSERT_TRUE(rig.bring_to_enabled());
  rig.motor.error = 0x40;
  rig.motor.state = 1;
  rig.run_ms(200);
  ASSERT_TRUE(rig.bus->rearm());
  rig.run_ms(900);
  EXPECT_EQ(rig.bus->phase(), BusPhase::kReady);
  EXPECT_EQ(rig.motor.state, 1);
  ASSERT_TRUE(rig.bus->enable());
  rig.run_ms(300);
  EXPECT_EQ(rig.motor.state, 8);
}

}  // namespace
}  // namespace can
