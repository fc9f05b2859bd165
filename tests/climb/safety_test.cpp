// SPDX-License-Identifier: BSD-3-Clause
// The gate before every send, with everything that must not come through.
#include "climb/safety.h"

#include <bit>

#include <gtest/gtest.h>

#include "base/rng.h"
#include "tests/climb/robot_poses.h"

namespace climb {
namespace {

using climb_tests::kInfinity;
using climb_tests::kNan;

constexpr std::int64_t kNow_us = 5'000'000;
const PerAxis<AxisLimits> kLimits = axis_limits(RobotParams());

PerAxis<double> middle() {
  PerAxis<double> positions;
  for (int axis = 0; axis < kNumAxes; ++axis) {
    positions[axis] = 0.5 * (kLimits[axis].min_rad + kLimits[axis].max_rad);
  }
  return positions;
}

PerAxis<AxisCommand> hold_at(const PerAxis<double>& positions) {
  PerAxis<AxisCommand> commands;
  for (int axis = 0; axis < kNumAxes; ++axis) {
    commands[axis] = {positions[axis], 0.0, 0.0, kLimits[axis].max_torque_Nm};
  }
  return commands;
}

SafetyGate started() {
  SafetyGate gate(kLimits, GateParams());
  EXPECT_TRUE(gate.start_at(middle()).passed());
  return gate;
}

// The limits themselves follow the robot: knees on their own side, jaws beyond both stops.
TEST(SafetyGate, TakesItsLimitsFromTheRobot) {
  EXPECT_EQ(check(kLimits), "");
  EXPECT_GT(kLimits[axis_of(kFrontLeft, 2)].min_rad, 0.0);
  EXPECT_LT(kLimits[axis_of(kRearRight, 2)].max_rad, 0.0);
  EXPECT_LT(kLimits[axis_of(kRearRight, kJaw)].min_rad, ClawParams().closed_rad);
}

// Before a measured position is known nothing passes.
TEST(SafetyGate, SendsNothingBeforeItKnowsWhereTheAxesAre) {
  SafetyGate gate(kLimits, GateParams());
  EXPECT_EQ(gate.pass(hold_at(middle()), kNow_us, kNow_us).reason, GateReason::kNotStarted);
  EXPECT_FALSE(gate.started());
  gate = started();
  EXPECT_TRUE(gate.pass(hold_at(middle()), kNow_us, kNow_us).passed());
  gate.stop();
  EXPECT_EQ(gate.pass(hold_at(middle()), kNow_us, kNow_us).reason, GateReason::kNotStarted);
}

// A start that is no position or far outside the limits is refused, axis by axis.
TEST(SafetyGate, RefusesAnImplausibleStart) {
  for (int axis = 0; axis < kNumAxes; ++axis) {
    for (const double bad : {kNan, kInfinity, -kInfinity, 1e300, kLimits[axis].max_rad + 0.03}) {
      SafetyGate gate(kLimits, GateParams());
      PerAxis<double> measured = middle();
      measured[axis] = bad;
      EXPECT_EQ(gate.start_at(measured).axis, axis);
      EXPECT_FALSE(gate.started());
    }
  }
}

// Every single bad number in every field of every axis holds all axes and names reason and axis.
TEST(SafetyGate, HoldsOnAnyBadNumber) {
  for (int axis = 0; axis < kNumAxes; ++axis) {
    for (int field = 0; field < 4; ++field) {
      for (const double bad : {kNan, kInfinity, -kInfinity, 1e300, -1e300}) {
        SafetyGate gate = started();
        PerAxis<AxisCommand> wanted = hold_at(middle());
        double* const fields[] = {&wanted[axis].position_rad, &wanted[axis].velocity_rad_s,
                                  &wanted[axis].torque_Nm, &wanted[axis].max_torque_Nm};
        *fields[field] = bad;
        const GateVerdict verdict = gate.pass(wanted, kNow_us, kNow_us);
        EXPECT_EQ(verdict.axis, axis);
        if (!std::isfinite(bad)) {
          EXPECT_EQ(verdict.reason, GateReason::kNotFinite);
        }
        for (int other = 0; other < kNumAxes; ++other) {
          EXPECT_EQ(gate.sent()[other].position_rad, middle()[other]);
        }
      }
    }
  }
}

// Limits that are inverted, not finite or not positive, and a period that is none: never a pass.
TEST(SafetyGate, RefusesBadLimitsForEver) {
  for (int axis = 0; axis < kNumAxes; ++axis) {
    for (int kind = 0; kind < 6; ++kind) {
      PerAxis<AxisLimits> limits = kLimits;
      AxisLimits& bad = limits[axis];
      if (kind == 0) std::swap(bad.min_rad, bad.max_rad);
      if (kind == 1) bad.max_rad = kNan;
      if (kind == 2) bad.min_rad = -kInfinity;
      if (kind == 3) bad.max_velocity_rad_s = 0.0;
      if (kind == 4) bad.max_velocity_rad_s = kInfinity;
      if (kind == 5) bad.max_torque_Nm = -1.0;
      EXPECT_NE(check(limits), "");
      SafetyGate gate(limits, GateParams());
      EXPECT_EQ(gate.start_at(middle()).reason, GateReason::kBadLimits);
      EXPECT_EQ(gate.pass(hold_at(middle()), kNow_us, kNow_us).axis, axis);
    }
  }
  for (const double period : {0.0, -0.01, kNan, kInfinity}) {
    SafetyGate gate(kLimits, {period, 20'000, 0.02});
    EXPECT_EQ(gate.start_at(middle()).reason, GateReason::kBadLimits);
  }
}

// Fresh means computed within two cycles and not in the future.
TEST(SafetyGate, PassesOnlyFreshCommands) {
  SafetyGate gate = started();
  const auto reason = [&](std::int64_t age_us) {
    return gate.pass(hold_at(middle()), kNow_us - age_us, kNow_us).reason;
  };
  EXPECT_EQ(reason(0), GateReason::kPassed);
  EXPECT_EQ(reason(20'000), GateReason::kPassed);
  EXPECT_EQ(reason(20'001), GateReason::kStale);
  EXPECT_EQ(reason(-1), GateReason::kStale);
}

// A step of exactly v T passes, a little more does not; elapsed time buys nothing.
TEST(SafetyGate, LimitsTheStep) {
  for (int axis = 0; axis < kNumAxes; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      const double step = sign * kLimits[axis].max_velocity_rad_s * 0.01;
      SafetyGate gate = started();
      PerAxis<AxisCommand> wanted = hold_at(middle());
      wanted[axis].position_rad += step;
      EXPECT_TRUE(gate.pass(wanted, kNow_us, kNow_us).passed());
      wanted[axis].position_rad += 1.001 * step;
      const GateVerdict verdict = gate.pass(wanted, kNow_us + 1'000'000, kNow_us + 1'000'000);
      EXPECT_EQ(verdict.reason, GateReason::kRate);
      EXPECT_EQ(verdict.axis, axis);
    }
  }
}

// An axis measured just outside its limit may stay or come back, not go farther out.
TEST(SafetyGate, LeavesTheLimitOnlyInwards) {
  PerAxis<double> measured = middle();
  measured[0] = kLimits[0].max_rad + 0.01;
  SafetyGate gate(kLimits, GateParams());
  ASSERT_TRUE(gate.start_at(measured).passed());
  EXPECT_TRUE(gate.pass(hold_at(measured), kNow_us, kNow_us).passed());
  measured[0] += 0.001;
  EXPECT_EQ(gate.pass(hold_at(measured), kNow_us, kNow_us).reason, GateReason::kPosition);
  measured[0] -= 0.006;
  EXPECT_TRUE(gate.pass(hold_at(measured), kNow_us, kNow_us).passed());
  measured[0] += 0.001;
  EXPECT_EQ(gate.pass(hold_at(measured), kNow_us, kNow_us).reason, GateReason::kPosition);
}

double any_double(base::Rng& rng, double usual) {
  const double kind = rng.uniform();
  if (kind < 0.97) return usual;
  if (kind < 0.985) return std::bit_cast<double>(rng.next());  // any bits at all
  return usual + climb_tests::between(rng, -0.1, 0.1);
}

// Whatever is wanted, what is sent is finite, within limits, and steps at most v T (invariant 2).
TEST(SafetyGate, SendsOnlyWhatAnAxisCanDo) {
  base::Rng rng(31);
  SafetyGate gate = started();
  int num_passed = 0;
  for (int cycle = 0; cycle < 200'000; ++cycle) {
    const PerAxis<AxisCommand> before = gate.sent();
    PerAxis<AxisCommand> wanted = before;
    for (int axis = 0; axis < kNumAxes; ++axis) {
      const double step = kLimits[axis].max_velocity_rad_s * 0.01;
      wanted[axis].position_rad =
          any_double(rng, before[axis].position_rad + climb_tests::between(rng, -step, step));
      wanted[axis].velocity_rad_s = any_double(rng, 0.0);
      wanted[axis].torque_Nm = any_double(rng, 1.0);
    }
    num_passed += gate.pass(wanted, kNow_us, kNow_us).passed() ? 1 : 0;
    for (int axis = 0; axis < kNumAxes; ++axis) {
      const AxisCommand& sent = gate.sent()[axis];
      const AxisLimits& limits = kLimits[axis];
      ASSERT_TRUE(sent.position_rad >= limits.min_rad && sent.position_rad <= limits.max_rad);
      ASSERT_TRUE(std::abs(sent.velocity_rad_s) <= limits.max_velocity_rad_s * 1.000001);
      ASSERT_TRUE(std::abs(sent.torque_Nm) <= limits.max_torque_Nm);
      ASSERT_TRUE(std::abs(sent.position_rad - before[axis].position_rad) <=
                  limits.max_velocity_rad_s * 0.01 * 1.000001);
    }
  }
  EXPECT_GT(num_passed, 1000);
}

}  // namespace
}  // namespace climb
