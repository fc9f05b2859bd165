// SPDX-License-Identifier: BSD-3-Clause
// A controller on the kinematic stand, driven by orders; what is sent is checked on the way.
#pragma once

#include <gtest/gtest.h>

#include "tests/climb/ladder_stand.h"
#include "tests/climb/robot_poses.h"

namespace climb_tests {

using namespace climb;  // NOLINT: tests of that namespace
using S = ControllerState;

constexpr std::uint64_t kSession = 0x5e551011;

inline ControllerParams params() {
  ControllerParams params;
  params.session_id = kSession;
  // The stand's claws hold a rung at the foot's point.
  params.climb.robot.claw.seat_up_m = params.climb.robot.claw.seat_out_m = 0.0;
  return params;
}

class ControllerFixture : public testing::Test {
 protected:
  void order(Order what, std::uint64_t session = kSession) {
    stand_.input.command = {what, session, ++seq_};
    cycle();
  }
  void cycle() {
    const PerAxis<AxisCommand> before = output_.axes;
    const bool sent_before = output_.send;
    controller_.step(stand_.input, output_);
    int num_moving = 0;
    for (const Leg leg : kLegs) num_moving += controller_.limb(leg).moves() ? 1 : 0;
    EXPECT_LE(num_moving, 1);
    if (output_.send) check_sent(before, sent_before);
    stand_.step(output_);
  }
  /// Invariants 2 and 6 on everything that is sent.
  void check_sent(const PerAxis<AxisCommand>& before, bool sent_before) {
    const PerAxis<AxisLimits> limits = axis_limits(params().climb.robot);
    for (int axis = 0; axis < kNumAxes; ++axis) {
      const double last_rad =
          sent_before ? before[axis].position_rad : stand_.input.axes[axis].position_rad;
      const double step_rad = std::abs(output_.axes[axis].position_rad - last_rad);
      ASSERT_TRUE(step_rad <= limits[axis].max_velocity_rad_s * 0.01 * 1.0001);
    }
  }
  bool reach(S state, double within_s) {
    for (int i = 0; i < static_cast<int>(within_s * 100.0); ++i) {
      if (output_.state == state) return true;
      cycle();
    }
    return output_.state == state;
  }
  bool arm() {
    if (!reach(S::kDisarmed, 1.0)) return false;
    order(Order::kArm);
    return reach(S::kHold, 60.0);
  }
  bool reach_limb(Leg leg, LimbState state, double within_s) {
    for (int i = 0; i < static_cast<int>(within_s * 100.0); ++i) {
      if (output_.limbs[leg] == state) return true;
      cycle();
    }
    return false;
  }
  /// Armed, and the rear right limb of the first step in this state.
  void climb_to(LimbState stage) {
    start_anew();
    ASSERT_TRUE(arm()) << where();
    order(Order::kClimb);
    ASSERT_TRUE(reach_limb(kRearRight, stage, 20.0)) << where();
  }
  void start_anew() {
    stand_ = LadderStand(params().climb);
    controller_ = Controller(params());
    output_ = ControllerOutput();
    seq_ = 0;
  }
  void run(double seconds) {
    for (int i = 0; i < static_cast<int>(seconds * 100.0); ++i) cycle();
  }
  std::string where() const {
    std::string text = name(output_.state);
    text += std::string(" reason ") + name(output_.reason) + " gate " + name(output_.gate.reason) +
            " axis " + std::to_string(output_.gate.axis) + " refusal " + name(output_.refusal) +
            " burden " + name(output_.burden);
    for (const Leg leg : kLegs) {
      const GraspWitness witness = controller_.limb(leg).last_witness();
      text += witness.touch ? " T" : " -";
      text += witness.jaw ? "J" : "-";
      text += witness.torque ? "F" : "-";
      text += witness.pull ? "P" : "-";
    }
    for (const Leg leg : kLegs) text += std::string(" ") + name(output_.limbs[leg]);
    return text;
  }

  LadderStand stand_{params().climb};
  Controller controller_{params()};
  ControllerOutput output_;
  std::int64_t seq_ = 0;
};

}  // namespace climb_tests
