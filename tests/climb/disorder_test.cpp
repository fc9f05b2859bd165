// SPDX-License-Identifier: BSD-3-Clause
// Everything at random: rungs break, claws slip off, jaws jam, numbers turn to nonsense, faults
// come and go, orders come at any time. What must hold then holds in every cycle, and afterwards
// the operator's orders lead out of whatever it led to.
#include <gtest/gtest.h>

#include "tests/climb/controller_fixture.h"

namespace climb {
namespace {

using climb_tests::kInfinity;
using climb_tests::kNan;
using climb_tests::kSession;
using climb_tests::params;
using S = ControllerState;

constexpr Order kOrders[] = {Order::kArm,   Order::kClimb, Order::kClimb, Order::kClimbDown,
                             Order::kPause, Order::kHold,  Order::kReset, Order::kDisarm};

class DisorderTest : public climb_tests::ControllerFixture {
 protected:
  /// One cycle, with what must hold in each.
  void checked_cycle() {
    const ControllerOutput before = output_;
    cycle();
    const bool stops_anew = before.putting_down && !output_.putting_down;
    if (output_.state != before.state || stops_anew) in_state_s_ = 0.0;
    in_state_s_ += 0.01;
    for (const Leg leg : kLegs) {
      touched_s_[leg] = stand_.input.touch[leg] ? 0.0 : touched_s_[leg] + 0.01;
      const bool same = output_.limbs[leg] == before.limbs[leg];
      const bool goes_on = output_.state == S::kClimbing || output_.putting_down;
      in_limb_state_s_[leg] = same && goes_on ? in_limb_state_s_[leg] + 0.01 : 0.0;
      const bool rests = output_.limbs[leg] == LimbState::kLoaded || !controller_.limb(leg).moves();
      ASSERT_TRUE(rests || in_limb_state_s_[leg] < 6.0) << where();
    }
    check_opening(before);
    check_stop(before);
  }
  /// Invariants 1 and 3: a claw opens only while the three others hold.
  void check_opening(const ControllerOutput& before) {
    if (output_.state == S::kDisarming) return;
    for (const Leg leg : kLegs) {
      const bool opens =
          output_.limbs[leg] == LimbState::kReleasing && before.limbs[leg] == LimbState::kUnloading;
      if (!opens) continue;
      for (const Leg other : kLegs) {
        if (other == leg) continue;
        ASSERT_TRUE(is_confirmed(output_.limbs[other])) << where();
        ASSERT_LE(touched_s_[other], 0.05) << where();
      }
    }
  }
  /// Invariants 4 and 8: a stop has a reason, and stands after 0.3 s.
  void check_stop(const ControllerOutput& before) {
    if (!is_latched(output_.state)) return;
    ASSERT_NE(output_.reason, Fault::kNone);
    const bool settled = in_state_s_ > 0.3 && output_.send && before.send;
    if (!settled || output_.putting_down) return;
    for (int axis = 0; axis < kNumAxes; ++axis) {
      if (axis % kNumAxesPerLeg == kJaw) continue;
      ASSERT_NEAR(output_.axes[axis].position_rad, before.axes[axis].position_rad, 1e-6)
          << axis << where();
    }
  }
  void disturb(base::Rng& rng) {
    const double what = rng.uniform();
    if (what < 0.0010) stand_.input.faults |= FaultFlags{1} << rng.below(kNumFaults);
    if (what > 0.99) stand_.input.faults = 0;
    if (what > 0.40 && what < 0.42) {
      stand_.input.command = {kOrders[rng.below(std::size(kOrders))], kSession, ++seq_};
    }
    if (what > 0.500 && what < 0.5004) stand_.drop(kLegs[rng.below(kNumLegs)]);
    if (what > 0.510 && what < 0.5104) stand_.break_rung(static_cast<int>(1 + rng.below(9)));
    if (what > 0.520 && what < 0.5204) {
      stand_.stuck_jaw_rad[rng.below(kNumLegs)] = climb_tests::between(rng, -0.6, 1.2);
    }
    if (what > 0.530 && what < 0.5340) {
      for (double& jaw_rad : stand_.stuck_jaw_rad) jaw_rad = climb_tests::LadderStand::kMoves;
    }
    if (what > 0.540 && what < 0.5405) stand_.sees = !stand_.sees;
    if (what > 0.550 && what < 0.5510) stand_.input.axes[rng.below(kNumAxes)].torque_Nm = kNan;
    if (what > 0.560 && what < 0.5602) stand_.input.axes[rng.below(kNumAxes)].position_rad = kNan;
    if (what > 0.570 && what < 0.5702) stand_.input.imu.q_odom_body.w() = kNan;
  }
  void calm_down() {
    stand_.input.faults = 0;
    stand_.input.imu.q_odom_body = stand_.upright();
    stand_.sees = true;
    stand_.mend_rungs();
    for (double& jaw_rad : stand_.stuck_jaw_rad) jaw_rad = climb_tests::LadderStand::kMoves;
  }

  PerLeg<double> touched_s_{};
  PerLeg<double> in_limb_state_s_{};
  double in_state_s_ = 0.0;
};

// 130 half minutes of it; then everything is mended, and hold, reset and arm lead to a state of
// rest.
TEST_F(DisorderTest, KeepsItsInvariantsAndLeadsOut) {
  for (std::uint64_t seed = 0; seed < 130; ++seed) {
    SCOPED_TRACE(seed);
    base::Rng rng(seed);
    start_anew();
    ASSERT_TRUE(arm()) << where();
    stand_.input.command = {Order::kClimb, kSession, ++seq_};
    for (int i = 0; i < 3000; ++i) {
      disturb(rng);
      checked_cycle();
      if (HasFatalFailure()) return;
      stand_.input.imu.q_odom_body = stand_.upright();
    }
    calm_down();
    int num_held = 0;
    for (const Leg leg : kLegs) num_held += stand_.held(leg) ? 1 : 0;
    if (num_held < 3) continue;  // that is for people to mend, not for the operator
    for (int i = 0; i < 4 && output_.state != S::kHold; ++i) {
      for (const Order what : {Order::kReset, Order::kHold, Order::kHold, Order::kArm}) {
        if (output_.state == S::kHold) continue;
        order(what);
        for (int k = 0; k < 600 || (k < 12'000 && output_.state == S::kArming); ++k)
          checked_cycle();
        if (HasFatalFailure()) return;
      }
    }
    EXPECT_EQ(output_.state, S::kHold) << where();
  }
}

// Nonsense in any one field, in any stage of a step, for one cycle or for good: what is sent stays
// finite and within its rate, and where it matters it stops with a reason.
TEST_F(DisorderTest, AnyBadNumber) {
  for (const LimbState stage : {LimbState::kUnloading, LimbState::kTransit, LimbState::kApproach,
                                LimbState::kClosing, LimbState::kVerify, LimbState::kLoading}) {
    climb_to(stage);
    const climb_tests::LadderStand stand = stand_;
    const Controller controller = controller_;
    const ControllerOutput output = output_;
    for (int field = 0; field < 2 * kNumAxes + 5 + 6; ++field) {
      for (const double bad : {kNan, kInfinity, -kInfinity, 1e300}) {
        stand_ = stand;
        controller_ = controller;
        output_ = output;
        for (int i = 0; i < 30; ++i) {
          double* const imu = stand_.input.imu.q_odom_body.coeffs().data();
          std::vector<RungView> rungs = stand_.rungs;
          if (field < kNumAxes)
            stand_.input.axes[field].position_rad = bad;
          else if (field < 2 * kNumAxes)
            stand_.input.axes[field - kNumAxes].torque_Nm = bad;
          else if (field < 2 * kNumAxes + 4)
            imu[field - 2 * kNumAxes] = bad;
          else if (field == 2 * kNumAxes + 4)
            stand_.input.imu.acceleration_m_s2 = bad;
          else
            rungs[1].end0_m.data()[field % 3] = rungs[2].radius_m = bad;
          stand_.input.ladder.rungs = rungs;
          cycle();
          stand_.input.imu.q_odom_body = stand_.upright();
          stand_.input.imu.acceleration_m_s2 = 9.81;
          for (const AxisCommand& axis : output_.axes) {
            ASSERT_TRUE(std::isfinite(axis.position_rad) && std::isfinite(axis.velocity_rad_s) &&
                        std::isfinite(axis.torque_Nm));
          }
        }
        const bool is_joint = field < kNumAxes && field % kNumAxesPerLeg != kJaw;
        const bool is_imu = field >= 2 * kNumAxes && field < 2 * kNumAxes + 4;
        if (is_joint || is_imu) {
          EXPECT_EQ(output_.state, S::kFaultHold) << field << " " << bad << where();
        }
      }
    }
  }
}

}  // namespace
}  // namespace climb
