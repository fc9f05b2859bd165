// SPDX-License-Identifier: BSD-3-Clause
// climb.can.protocol = "odrive": the same ControlCycle on ODrives, from configuration to frames.
#include <array>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "climb/safety.h"
#include "climb_controller/config.h"
#include "climb_controller/control_cycle.h"
#include "runtime/config.h"
#include "tests/can/fake_line.h"
#include "tests/can/odrive_motor.h"

namespace climb_controller {
namespace {

using climb::CommandVerdict;
using climb::ControllerState;
using climb::Order;

constexpr std::uint64_t kSession = 0x0D21;

ServiceParams params_of(const std::vector<std::string>& overrides) {
  ServiceParams params = read_params(runtime::Config::load({}, overrides).table("climb"));
  params.cycle.controller.session_id = kSession;
  return params;
}

std::string problem_of(const std::vector<std::string>& overrides) {
  try {
    params_of(overrides);
    return "";
  } catch (const runtime::ConfigError& error) {
    return error.what();
  }
}

/// A float as the frame holds it.
std::string hex_of(float value) {
  can::CanFrame frame;
  frame.dlc = sizeof value;
  std::memcpy(frame.data.data(), &value, sizeof value);
  return can::hex(frame).substr(4);
}

/// Sixteen ODrives in the middle of their ranges; lines and IMU as they should be, no rungs.
class OdriveBench {
 public:
  explicit OdriveBench(std::vector<std::string> overrides) {
    overrides.push_back("climb.can.protocol=odrive");
    const ServiceParams params = params_of(overrides);
    const auto limits = climb::axis_limits(params.cycle.controller.climb.robot);
    for (int axis = 0; axis < climb::kNumAxes; ++axis) {
      constexpr double kTwoPi = 6.283185307179586;
      const double middle_rad = 0.5 * (limits[axis].min_rad + limits[axis].max_rad);
      motors.emplace_back(static_cast<std::uint8_t>(axis + 1));
      motors.back().estimates = hex_of(static_cast<float>(middle_rad / kTwoPi));
    }
    bus = make_servo_bus(params, line, nullptr);
    cycle = std::make_unique<ControlCycle>(params.cycle, *bus);
    inbox.lines.estop_clear = true;
    inbox.imu.valid = true;
  }

  void step() {
    cycle->step(time_ms * 1000, inbox, report);
    inbox.command = {};
    for (int i = 0; i < 10; ++i) {
      ++time_ms;
      for (; num_delivered < line.sent.size(); ++num_delivered) {
        for (can::OdriveMotor& motor : motors) motor.hear(line.sent[num_delivered]);
      }
      for (const can::OdriveMotor& motor : motors) motor.speak(line, time_ms);
    }
  }
  void run_s(double duration_s) {
    for (int i = 0; i < static_cast<int>(duration_s * 100.0 + 0.5); ++i) step();
  }
  bool reach(ControllerState wanted, double within_s = 20.0) {
    for (int i = 0; i < static_cast<int>(within_s * 100.0); ++i) {
      if (report.output.state == wanted) return true;
      step();
    }
    return report.output.state == wanted;
  }
  CommandVerdict order(Order order) {
    inbox.command = {order, kSession, ++seq};
    step();
    return report.verdict;
  }
  int num_armed() const {
    int num = 0;
    for (const can::OdriveMotor& motor : motors) num += motor.state == 8 ? 1 : 0;
    return num;
  }
  std::string problems() const {
    std::string text = std::string(climb::name(report.output.state)) + ", reason " +
                       climb::name(report.output.reason) + ", bus " + can::name(report.bus_phase);
    for (const can::Fault& fault : report.bus_faults) {
      text += std::string("\n") + can::name(fault.cause) + " axis " + std::to_string(fault.axis);
    }
    return text;
  }

  can::FakeLine line;
  std::vector<can::OdriveMotor> motors;
  std::unique_ptr<can::ServoBus> bus;
  std::unique_ptr<ControlCycle> cycle;
  CycleInbox inbox;
  CycleReport report;
  std::int64_t time_ms = 1000;
  std::int64_t seq = 0;
  std::size_t num_delivered = 0;
};

// The protocol is chosen by its name; what only the other one knows, or cannot hold, is refused.
TEST(OdriveConfig, IsChosenByName) {
  EXPECT_EQ(params_of({}).protocol, Protocol::kCia402);
  EXPECT_EQ(params_of({"climb.can.protocol=odrive"}).protocol, Protocol::kOdrive);
  EXPECT_NE(problem_of({"climb.can.protocol=odrives"}).find("protocol"), std::string::npos);
  const std::string node_64 = "climb.drives.node_id=[64,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16]";
  EXPECT_EQ(problem_of({node_64}), "");
  EXPECT_NE(problem_of({node_64, "climb.can.protocol=odrive"}).find("node_id"), std::string::npos);
  EXPECT_NE(problem_of({"climb.can.accepted_objects=605E:0", "climb.can.protocol=odrive"})
                .find("accepted_objects"),
            std::string::npos);
  EXPECT_NE(problem_of({"climb.can.torque_constant_Nm_A=0.0", "climb.can.protocol=odrive"})
                .find("torque_constant_Nm_A"),
            std::string::npos);
}

// An ODrive lets go when its master is gone: it is never armed to climb, and the reason is told.
TEST(OdriveCycle, IsNotArmedToClimb) {
  OdriveBench bench({});
  bench.run_s(3.0);
  EXPECT_EQ(bench.report.bus_phase, can::BusPhase::kReady) << bench.problems();
  EXPECT_EQ(bench.report.output.reason, climb::Fault::kConfiguration) << bench.problems();
  EXPECT_EQ(bench.order(Order::kArm), CommandVerdict::kNotNow);
  EXPECT_EQ(bench.report.policy, Policy::kNoHoldOnLoss);
  bench.run_s(1.0);
  EXPECT_EQ(bench.num_armed(), 0);
}

// Allowed for ground tests they are armed where they stand, hold, never climb, and are disarmed.
TEST(OdriveCycle, HoldsOnTheGround) {
  OdriveBench bench({"climb.allow_no_hold_on_loss=true"});
  ASSERT_TRUE(bench.reach(ControllerState::kDisarmed)) << bench.problems();
  const auto before = bench.report.axes;
  ASSERT_EQ(bench.order(Order::kArm), CommandVerdict::kAccepted) << bench.problems();
  ASSERT_TRUE(bench.reach(ControllerState::kHold)) << bench.problems();
  bench.run_s(1.0);
  EXPECT_EQ(bench.num_armed(), climb::kNumAxes);
  for (int axis = 0; axis < climb::kNumAxes; ++axis) {
    EXPECT_NEAR(bench.report.axes[axis].position_rad, before[axis].position_rad, 1e-3) << axis;
  }
  EXPECT_EQ(bench.order(Order::kClimb), CommandVerdict::kNotNow);
  EXPECT_EQ(bench.report.policy, Policy::kGroundTest);
  ASSERT_EQ(bench.order(Order::kDisarm), CommandVerdict::kAccepted);
  EXPECT_TRUE(bench.reach(ControllerState::kDisarmed)) << bench.problems();
  EXPECT_EQ(bench.num_armed(), 0);
}

// A motor that stops answering while they hold: everything stays where it is, latched.
TEST(OdriveCycle, SilentMotorStopsAll) {
  OdriveBench bench({"climb.allow_no_hold_on_loss=true"});
  ASSERT_TRUE(bench.reach(ControllerState::kDisarmed)) << bench.problems();
  ASSERT_EQ(bench.order(Order::kArm), CommandVerdict::kAccepted) << bench.problems();
  ASSERT_TRUE(bench.reach(ControllerState::kHold)) << bench.problems();
  bench.motors[5].is_silent = true;
  EXPECT_TRUE(bench.reach(ControllerState::kFaultHold, 0.1)) << bench.problems();
  bench.run_s(1.0);
  EXPECT_EQ(bench.report.output.state, ControllerState::kFaultHold);
}

}  // namespace
}  // namespace climb_controller
