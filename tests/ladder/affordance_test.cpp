// SPDX-License-Identifier: BSD-3-Clause
// Stretches offered and refused on rungs given directly.
#include "ladder/affordance.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "base/rng.h"

namespace {

using ladder::Affordance;
using ladder::Interval;
using ladder::LadderEstimate;
using ladder::LadderParams;
using ladder::RailLine;
using ladder::Reason;
using ladder::Rung;
using ladder::RungState;
using ladder::RungSurface;

const Eigen::Vector3d kBody_m(0.0, 0.0, 0.5);
constexpr double kClaw_m = 0.034 + 0.012;

Rung trusted_rung(double length_m, double z_m) {
  Rung rung;
  rung.state = RungState::kTrusted;
  rung.confidence = 0.5;
  rung.end0_m = {1.0, 0.5 * length_m, z_m};
  rung.end1_m = {1.0, -0.5 * length_m, z_m};
  rung.radius_m = 0.014;
  return rung;
}

RungSurface whole_surface() {
  RungSurface surface;
  surface.seen.set();
  surface.may_be_offered = true;
  return surface;
}

struct Bench {
  LadderEstimate estimate;
  std::vector<RungSurface> surfaces;
  std::vector<RailLine> rails;
  LadderParams params;

  void add(const Rung& rung, const RungSurface& surface = whole_surface()) {
    estimate.rungs.push_back(rung);
    surfaces.push_back(surface);
  }
  void find() { Affordance(params).find(surfaces, rails, kBody_m, estimate); }
  /// Reason of the stretch that holds the place; kUnknown where there is none.
  Reason at(int rung, double along_m) const {
    for (const Interval& i : estimate.intervals) {
      if (i.rung == rung && along_m >= i.from_m && along_m <= i.to_m) return i.reason;
    }
    return Reason::kUnknown;
  }
};

// A free rung is offered but for the claw's width at both ends, in its middle, level towards it.
TEST(Affordance, OffersTheMiddleOfASoundRung) {
  Bench bench;
  bench.add(trusted_rung(0.40, 0.9));
  bench.find();
  ASSERT_EQ(bench.estimate.intervals.size(), 3U);
  EXPECT_EQ(bench.estimate.intervals[0].reason, Reason::kRailTooNear);
  EXPECT_EQ(bench.estimate.intervals[1].reason, Reason::kNone);
  EXPECT_NEAR(bench.estimate.intervals[1].from_m, kClaw_m, 0.005);
  EXPECT_NEAR(bench.estimate.intervals[1].to_m, 0.40 - kClaw_m, 0.005);
  ASSERT_EQ(bench.estimate.grasps.size(), 1U);
  EXPECT_LT((bench.estimate.grasps[0].position_m - Eigen::Vector3d(1.0, 0.0, 0.9)).norm(), 0.003);
  EXPECT_LT((bench.estimate.grasps[0].approach - Eigen::Vector3d::UnitX()).norm(), 1e-9);
  EXPECT_EQ(bench.estimate.grasps[0].confidence, 0.5);
}

// What is not trusted, too young, damaged, too tilted or a board gets no offer, and says why.
TEST(Affordance, RefusesWhatIsNotSound) {
  Bench bench;
  Rung candidate = trusted_rung(0.4, 0.1);
  candidate.state = RungState::kCandidate;
  bench.add(candidate);
  RungSurface young = whole_surface();
  young.may_be_offered = false;
  bench.add(trusted_rung(0.4, 0.4), young);
  for (const int flag : {ladder::kFlagStub, ladder::kFlagBent, ladder::kFlagSagged}) {
    Rung damaged = trusted_rung(0.4, 0.7 + 0.3 * flag);
    damaged.flags = static_cast<std::uint16_t>(flag);
    bench.add(damaged);
  }
  RungSurface tilted = whole_surface();
  tilted.tilt_sin = 0.3;
  bench.add(trusted_rung(0.4, 3.0), tilted);
  RungSurface tread = whole_surface();
  tread.is_tread = true;
  bench.add(trusted_rung(0.4, 3.3), tread);
  bench.find();
  EXPECT_TRUE(bench.estimate.grasps.empty());
  ASSERT_EQ(bench.estimate.intervals.size(), 7U);
  EXPECT_EQ(bench.estimate.intervals[0].reason, Reason::kNotTrusted);
  EXPECT_EQ(bench.estimate.intervals[1].reason, Reason::kNotTrusted);
  for (int i = 2; i < 6; ++i) EXPECT_EQ(bench.estimate.intervals[i].reason, Reason::kDamaged);
  EXPECT_EQ(bench.estimate.intervals[6].reason, Reason::kTooDeep);
}

// A rail through the middle is kept clear of by the claw and the rail's half width.
TEST(Affordance, KeepsClearOfARailInTheMiddle) {
  Bench bench;
  bench.add(trusted_rung(0.40, 0.9));
  bench.rails.push_back({{1.0, 0.05, 0.0}, {1.0, 0.05, 2.0}, 0.01});
  bench.find();
  EXPECT_EQ(bench.at(0, 0.15), Reason::kRailTooNear);
  EXPECT_EQ(bench.at(0, 0.15 + kClaw_m + 0.01 + 0.01), Reason::kNone);
  EXPECT_EQ(bench.at(0, 0.15 + kClaw_m + 0.01 - 0.006), Reason::kRailTooNear);
  ASSERT_EQ(bench.estimate.grasps.size(), 1U);
  EXPECT_LT(bench.estimate.grasps[0].position_m.y(), 0.0);
}

// A rung whose ends are known less well is offered so much less at either end; one known too badly
// not at all.
TEST(Affordance, WidensTheMarginToWhatIsKnown) {
  Bench bench;
  RungSurface vague = whole_surface();
  vague.margin_m = 0.030;
  bench.add(trusted_rung(0.40, 0.6), vague);
  vague.margin_m = 0.5;
  bench.add(trusted_rung(0.40, 0.9), vague);
  bench.find();
  const double claw_m = bench.params.affordance.claw_width_m;
  EXPECT_EQ(bench.at(0, claw_m + 0.030 - 0.006), Reason::kRailTooNear);
  EXPECT_EQ(bench.at(0, claw_m + 0.030 + 0.006), Reason::kNone);
  EXPECT_EQ(bench.at(0, 0.40 - claw_m - 0.030 + 0.006), Reason::kRailTooNear);
  EXPECT_EQ(bench.at(1, 0.2), Reason::kRailTooNear);
  EXPECT_EQ(bench.estimate.grasps.size(), 1U);
}

// A rail that ends below the rung does not count.
TEST(Affordance, IgnoresARailThatEndsElsewhere) {
  Bench bench;
  bench.add(trusted_rung(0.40, 0.9));
  bench.rails.push_back({{1.0, 0.0, 0.0}, {1.0, 0.0, 0.7}, 0.01});
  bench.find();
  EXPECT_EQ(bench.at(0, 0.2), Reason::kNone);
}

// Something attached, an unseen stretch and a crossing bar are refused where they are, and only
// there.
TEST(Affordance, RefusesAttachedUnseenAndCrossedStretches) {
  Bench bench;
  RungSurface attached = whole_surface();
  ladder::mark(attached.attached, 0.18, 0.22, 0.40);
  bench.add(trusted_rung(0.40, 0.3), attached);
  RungSurface unseen = whole_surface();
  for (int i = 0; i < ladder::kNumStretches / 4; ++i)
    unseen.seen.reset(i + ladder::kNumStretches / 2);
  bench.add(trusted_rung(0.40, 0.6), unseen);
  bench.add(trusted_rung(0.40, 0.9));
  Rung crossing = trusted_rung(0.4, 1.2);
  crossing.state = RungState::kCandidate;
  crossing.end0_m = {1.0, 0.1, 0.85};
  crossing.end1_m = {1.0, 0.1, 1.1};
  bench.add(crossing);
  bench.find();
  EXPECT_EQ(bench.at(0, 0.20), Reason::kOutlierTooNear);
  EXPECT_EQ(bench.at(0, 0.10), Reason::kNone);
  EXPECT_EQ(bench.at(0, 0.30), Reason::kNone);
  EXPECT_EQ(bench.at(1, 0.25), Reason::kNotSeen);
  EXPECT_EQ(bench.at(1, 0.10), Reason::kNone);
  EXPECT_EQ(bench.at(2, 0.10), Reason::kOtherRungTooNear);
  EXPECT_EQ(bench.at(2, 0.20), Reason::kNone);
}

// What remains of a rung when it is shorter than the gripper is not offered.
TEST(Affordance, RefusesWhatIsTooShort) {
  Bench bench;
  bench.add(trusted_rung(2.0 * kClaw_m + 0.03, 0.9));
  bench.add(trusted_rung(0.02, 1.2));
  bench.add(trusted_rung(0.0, 1.5));
  bench.find();
  EXPECT_TRUE(bench.estimate.grasps.empty());
  EXPECT_EQ(bench.at(0, kClaw_m + 0.015), Reason::kTooShort);
  EXPECT_EQ(bench.at(1, 0.01), Reason::kTooShort);
  EXPECT_EQ(bench.at(2, 0.0), Reason::kTooShort);
}

// Of 10 000 random rungs, intervals cover each from end to end, no offered stretch comes nearer to
// an end, a rail or an attached thing than it may, and every grasp lies in an offered stretch.
TEST(Affordance, OffersNothingUnsafeOnRandomRungs) {
  base::Rng rng(17);
  for (int trial = 0; trial < 10000; ++trial) {
    Bench bench;
    const double length_m = 0.05 + 0.7 * rng.uniform();
    RungSurface surface = whole_surface();
    const double thing_m = length_m * rng.uniform();
    ladder::mark(surface.attached, thing_m - 0.02, thing_m + 0.02, length_m);
    bench.add(trusted_rung(length_m, 0.9), surface);
    const double rail_m = length_m * rng.uniform();
    const double rail_y_m = 0.5 * length_m - rail_m;
    bench.rails.push_back({{1.02, rail_y_m, 0.0}, {1.0, rail_y_m, 2.0}, 0.005});
    bench.find();
    double covered_to_m = 0.0;
    for (const Interval& i : bench.estimate.intervals) {
      ASSERT_NEAR(i.from_m, covered_to_m, 1e-9);
      covered_to_m = i.to_m;
      if (i.reason != Reason::kNone) continue;
      const double slack_m = 1e-9;
      EXPECT_GE(i.from_m, kClaw_m - slack_m);
      EXPECT_LE(i.to_m, length_m - kClaw_m + slack_m);
      EXPECT_GE(i.to_m - i.from_m, 0.040 - slack_m);
      EXPECT_TRUE(rail_m < i.from_m - kClaw_m || rail_m > i.to_m + kClaw_m);
      EXPECT_TRUE(thing_m < i.from_m - 0.019 || thing_m > i.to_m + 0.019);
    }
    EXPECT_NEAR(covered_to_m, length_m, 1e-9);
    for (const auto& grasp : bench.estimate.grasps) {
      EXPECT_EQ(bench.at(0, 0.5 * length_m - grasp.position_m.y()), Reason::kNone);
    }
  }
}

}  // namespace
