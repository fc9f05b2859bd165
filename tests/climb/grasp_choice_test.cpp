// SPDX-License-Identifier: BSD-3-Clause
// Choice of the next grasp: a table of refusals, the cheapest point, ties.
#include "climb/grasp_choice.h"

#include <functional>
#include <set>

#include <gtest/gtest.h>

#include "tests/climb/robot_poses.h"

namespace climb {
namespace {

using climb_tests::kInfinity;
using climb_tests::kNan;

const ClimbParams kParams;

/// A ladder in front of the robot (odom z up, ladder plane at x = 0, robot at x = -0.28, rung k at
/// height 0.3 k) and the right front claw about to go from rung 3 to rung 4.
struct Scene {
  Scene() {
    for (int k = 1; k <= 7; ++k) {
      RungView rung;
      rung.id = k;
      rung.trusted = true;
      rung.confidence = 1.0;
      rung.end0_m = Eigen::Vector3d(0.0, 0.2, 0.3 * k);
      rung.end1_m = Eigen::Vector3d(0.0, -0.2, 0.3 * k);
      rung.radius_m = 0.014;
      rung.covariance_m2 = 4e-6 * Eigen::Matrix3d::Identity();
      rungs.push_back(rung);
      stretches.push_back({k - 1, 0.02, 0.38});
    }
    query.leg = kFrontRight;
    Eigen::Matrix3d R;  // body x up, y left, z out of the ladder
    R << 0, 0, -1, 0, 1, 0, 1, 0, 0;
    query.T_odom_body.linear() = R;
    query.T_odom_body.translation() = Eigen::Vector3d(-0.28, 0.0, 0.75);
    query.next_shift_m = Eigen::Vector3d(0.0, 0.0, 0.075);
    query.from_m = Eigen::Vector3d(0.0, -0.15, 0.9);
    query.held[kFrontLeft] = {true, Eigen::Vector3d(0.0, 0.15, 0.9)};
    query.held[kRearLeft] = {true, Eigen::Vector3d(0.0, 0.15, 0.3)};
    query.held[kRearRight] = {true, Eigen::Vector3d(0.0, -0.15, 0.6)};
  }
  GraspDecision choose() {
    const LadderView ladder{rungs, stretches, age_s, confirmed};
    return choice.choose(ladder, query);
  }
  RungView& goal() { return rungs[3]; }
  StretchView& goal_stretch() { return stretches[3]; }

  std::vector<RungView> rungs;
  std::vector<StretchView> stretches;
  double age_s = 0.1;
  bool confirmed = true;
  GraspQuery query;
  GraspChoice choice{kParams};
};

// The next rung up, at the lateral home, before it the pregrasp 50 mm out along the claw's opening.
TEST(GraspChoice, TakesTheNextRungAtTheLateralHome) {
  Scene scene;
  const GraspDecision decision = scene.choose();
  ASSERT_EQ(decision.refusal, Refusal::kNone) << name(decision.refusal);
  EXPECT_EQ(decision.target.rung_id, 4);
  EXPECT_LE((decision.target.grasp_m - Eigen::Vector3d(0.0, -0.15, 1.2)).norm(), 1e-12);
  const LegKinematics kinematics(kParams.robot);
  const Eigen::Isometry3d& T_odom_body = scene.query.T_odom_body;
  const LegAngles there_rad =
      kinematics.inverse(kFrontRight, T_odom_body.inverse() * decision.target.grasp_m).angles_rad;
  const Eigen::Vector3d out =
      T_odom_body.linear() * kinematics.retract_direction(kFrontRight, there_rad);
  EXPECT_LE((decision.target.pregrasp_m - decision.target.grasp_m - 0.05 * out).norm(), 1e-9);
  EXPECT_LT(out.x(), -0.5);  // out of the ladder
  EXPECT_LE((decision.target.rung_axis - Eigen::Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_NEAR(decision.target.sigma_m, 0.002, 1e-9);
  ASSERT_EQ(decision.rungs.size(), 7U);
  EXPECT_EQ(decision.rungs[1].refusal, Refusal::kNotAhead);
  EXPECT_EQ(decision.rungs[2].refusal, Refusal::kNotAhead);
  EXPECT_EQ(decision.rungs[4].refusal, Refusal::kTooFarAhead);
}

struct RefusalCase {
  Refusal expected;
  std::function<void(Scene&)> change;
};

// One change to a good scene, one reason; every reason of a single rung is met here.
TEST(GraspChoice, RefusesForTheRightReason) {
  const std::vector<RefusalCase> cases = {
      {Refusal::kNotFinite, [](Scene& s) { s.goal().end0_m.x() = kNan; }},
      {Refusal::kNotFinite, [](Scene& s) { s.goal().covariance_m2(1, 2) = kInfinity; }},
      {Refusal::kNotFinite, [](Scene& s) { s.goal().confidence = kNan; }},
      {Refusal::kAvoided, [](Scene& s) { s.query.avoid_rung_id = 4; }},
      {Refusal::kNotTrusted, [](Scene& s) { s.goal().trusted = false; }},
      {Refusal::kDamaged, [](Scene& s) { s.goal().damaged = true; }},
      {Refusal::kLowConfidence, [](Scene& s) { s.goal().confidence = 0.24; }},
      {Refusal::kRadius, [](Scene& s) { s.goal().radius_m = 0.03; }},
      {Refusal::kRadius, [](Scene& s) { s.goal().radius_m = 0.0; }},
      {Refusal::kUncertain, [](Scene& s) { s.goal().covariance_m2 *= 17.0; }},
      {Refusal::kUncertain, [](Scene& s) { s.query.body_sigma_m = 0.0079; }},
      {Refusal::kNotAhead, [](Scene& s) { s.query.from_m.z() = 1.1; }},
      {Refusal::kTooFarAhead, [](Scene& s) { s.query.from_m.z() = 0.7; }},
      {Refusal::kNoStretch, [](Scene& s) { s.stretches.erase(s.stretches.begin() + 3); }},
      {Refusal::kStretchTooShort, [](Scene& s) { s.goal_stretch().from_m = 0.341; }},
      {Refusal::kStretchTooShort, [](Scene& s) { s.goal_stretch().to_m = kNan; }},
      {Refusal::kStretchTooShort, [](Scene& s) { s.goal().end1_m = s.goal().end0_m; }},
      {Refusal::kTooFarSideways, [](Scene& s) { s.goal_stretch().to_m = 0.30; }},
      {Refusal::kOccupied, [](Scene& s) { s.query.held[kRearRight].position_m.z() = 1.19; }},
      {Refusal::kPregraspOutOfReach,
       [](Scene& s) { s.query.T_odom_body.translation().x() = -0.045; }},
      {Refusal::kGraspOutOfReach, [](Scene& s) { s.query.T_odom_body.translation().x() = -0.459; }},
      {Refusal::kShiftOutOfReach, [](Scene& s) { s.query.next_shift_m.z() = -0.5; }},
      {Refusal::kJointMargin, [](Scene& s) { s.query.T_odom_body.translation().x() = -0.4575; }},
  };
  for (std::size_t i = 0; i < cases.size(); ++i) {
    Scene scene;
    if (cases[i].expected == Refusal::kGraspOutOfReach ||
        cases[i].expected == Refusal::kJointMargin) {
      scene.query.T_odom_body.translation().z() = 0.95;  // hip at the goal's height
      scene.query.next_shift_m.setZero();
    }
    cases[i].change(scene);
    const GraspDecision decision = scene.choose();
    ASSERT_GT(decision.rungs.size(), 3U) << i;
    EXPECT_EQ(decision.rungs[3].refusal, cases[i].expected)
        << "case " << i << ": " << name(decision.rungs[3].refusal);
    EXPECT_NE(decision.target.rung_id, 4) << i;
  }
}

// No rung a step away, but one at twice that: a rung is missing. Not where it is seen but damaged,
// nor where the ladder ends.
TEST(GraspChoice, TellsAMissingRung) {
  Scene missing;
  missing.rungs.erase(missing.rungs.begin() + 3);
  missing.stretches.erase(missing.stretches.begin() + 6);
  EXPECT_EQ(missing.choose().refusal, Refusal::kRungMissing);
  Scene damaged;
  damaged.goal().damaged = true;
  EXPECT_EQ(damaged.choose().refusal, Refusal::kDamaged);
  Scene ended;
  ended.rungs.resize(3);
  ended.stretches.resize(3);
  EXPECT_EQ(ended.choose().refusal, Refusal::kNotAhead);
  Scene far_off = missing;
  far_off.rungs.erase(far_off.rungs.begin() + 3, far_off.rungs.begin() + 5);
  far_off.stretches.resize(4);
  EXPECT_EQ(far_off.choose().refusal, Refusal::kTooFarAhead);
}

// A long step goes over the next rung only where that is none to grasp, and not over two.
TEST(GraspChoice, TakesTheRungBeyondInALongStep) {
  Scene scene;
  scene.query.is_long = true;
  scene.query.T_odom_body.translation().z() = 0.95;
  EXPECT_EQ(scene.choose().target.rung_id, 4);
  scene.goal().damaged = true;
  GraspDecision decision = scene.choose();
  ASSERT_EQ(decision.refusal, Refusal::kNone) << name(decision.refusal);
  EXPECT_EQ(decision.target.rung_id, 5);
  EXPECT_GT(decision.target.joint_margin_rad, 0.1);
  scene.query.is_long = false;
  EXPECT_EQ(scene.choose().refusal, Refusal::kDamaged);
  scene.query.is_long = true;
  scene.rungs[4].trusted = false;
  decision = scene.choose();
  EXPECT_EQ(decision.rungs[5].refusal, Refusal::kTooFarAhead);
  EXPECT_EQ(decision.refusal, Refusal::kDamaged);
}

// What was tried in vain is known by its place, whatever its rung is called now.
TEST(GraspChoice, AvoidsWhatDoesNotHold) {
  Scene scene;
  const Eigen::Vector3d vain_m(0.01, 0.1, 1.21);
  scene.query.vain_m = std::span(&vain_m, 1);
  scene.goal().id = 99;
  EXPECT_EQ(scene.choose().refusal, Refusal::kAvoided);
  const Eigen::Vector3d elsewhere_m(0.0, 0.0, 1.5);
  scene.query.vain_m = std::span(&elsewhere_m, 1);
  EXPECT_EQ(scene.choose().target.rung_id, 99);
}

// Both a stretch just as wide as offered by the perception and no wider than the claw and its
// margin may be used; its middle is then the grasp.
TEST(GraspChoice, TakesAJustWideEnoughStretch) {
  Scene scene;
  scene.goal_stretch() = {3, 0.33, 0.37};
  const GraspDecision decision = scene.choose();
  ASSERT_EQ(decision.refusal, Refusal::kNone) << name(decision.refusal);
  EXPECT_NEAR(decision.target.grasp_m.y(), -0.15, 1e-9);
}

// What is wrong with the whole is told for the whole.
TEST(GraspChoice, RefusesTheWhole) {
  const auto refusal_after = [](const std::function<void(Scene&)>& change) {
    Scene scene;
    change(scene);
    return scene.choose().refusal;
  };
  EXPECT_EQ(refusal_after([](Scene& s) { s.age_s = 0.31; }), Refusal::kStale);
  EXPECT_EQ(refusal_after([](Scene& s) { s.age_s = kNan; }), Refusal::kStale);
  EXPECT_EQ(refusal_after([](Scene& s) { s.age_s = -1.0; }), Refusal::kStale);
  EXPECT_EQ(refusal_after([](Scene& s) { s.confirmed = false; }), Refusal::kNoLadder);
  EXPECT_EQ(refusal_after([](Scene& s) { s.rungs.clear(); }), Refusal::kNoLadder);
  EXPECT_EQ(refusal_after([](Scene& s) { s.query.from_m.x() = kNan; }), Refusal::kNotFinite);
  EXPECT_EQ(refusal_after([](Scene& s) { s.query.body_sigma_m = kNan; }), Refusal::kNotFinite);
  EXPECT_EQ(refusal_after([](Scene& s) { s.query.T_odom_body.linear() *= 2.0; }),
            Refusal::kNotFinite);
  EXPECT_EQ(refusal_after([](Scene& s) { s.query.held[kRearLeft].position_m.x() = kNan; }),
            Refusal::kNotFinite);
}

// A leg that would stand near a singularity is refused, by its own reason.
TEST(GraspChoice, RefusesTheSingular) {
  Scene scene;
  ClimbParams strict = kParams;
  strict.grasp.min_sigma_J_m = 0.5;
  scene.choice = GraspChoice(strict);
  EXPECT_EQ(scene.choose().rungs[3].refusal, Refusal::kSingular);
}

// The approach between good ends may leave the reach: then that is the reason.
TEST(GraspChoice, LooksAtTheWayToo) {
  Scene scene;
  ClimbParams longer = kParams;
  longer.motion.pregrasp_m = 0.53;  // from behind the back to the ladder, through the hip
  longer.robot.abduction.max_rad = 3.1;
  longer.robot.abduction.min_rad = -3.1;
  longer.robot.knee_bend.max_rad = 3.0;
  scene.choice = GraspChoice(longer);
  scene.query.T_odom_body.translation().z() = 0.95;
  EXPECT_EQ(scene.choose().rungs[3].refusal, Refusal::kApproachOutOfReach);
}

// Two equal rungs in one place: the lower id wins, in whatever order they come.
TEST(GraspChoice, TiesGoToTheLowerId) {
  for (const bool swapped : {false, true}) {
    Scene scene;
    RungView twin = scene.goal();
    twin.id = 2004;
    scene.rungs.push_back(twin);
    scene.stretches.push_back({7, 0.02, 0.38});
    if (swapped) std::swap(scene.rungs[3].id, scene.rungs[7].id);
    EXPECT_EQ(scene.choose().target.rung_id, 4);
  }
}

// Among two rungs within reach the nearer, surer one is cheaper.
TEST(GraspChoice, PrefersTheNearerAndTheSurer) {
  Scene scene;
  RungView extra = scene.goal();
  extra.id = 1;
  extra.end0_m.z() = extra.end1_m.z() = 1.21;
  scene.rungs.push_back(extra);
  scene.stretches.push_back({7, 0.02, 0.38});
  EXPECT_EQ(scene.choose().target.rung_id, 4);
  scene.goal().covariance_m2 *= 14.0;  // 7.5 mm
  EXPECT_EQ(scene.choose().target.rung_id, 1);
}

// A rung whose ends come in the other order gives the same target.
TEST(GraspChoice, DoesNotMindTheOrderOfTheEnds) {
  Scene scene;
  const GraspTarget expected = scene.choose().target;
  std::swap(scene.goal().end0_m, scene.goal().end1_m);
  const GraspTarget target = scene.choose().target;
  EXPECT_LE((target.grasp_m - expected.grasp_m).norm(), 1e-12);
  EXPECT_LE((target.rung_axis - expected.rung_axis).norm(), 1e-12);
}

// On the way down the next rung is the one below.
TEST(GraspChoice, GoesDownToo) {
  Scene scene;
  scene.query.upwards = false;
  scene.query.from_m.z() = 1.2;
  scene.query.held[kFrontLeft].position_m.z() = 1.2;
  scene.query.next_shift_m.z() = -0.075;
  const GraspDecision decision = scene.choose();
  ASSERT_EQ(decision.refusal, Refusal::kNone) << name(decision.refusal);
  EXPECT_EQ(decision.target.rung_id, 3);
}

// The whole scene turned and moved in odom turns and moves the target.
TEST(GraspChoice, IsEquivariant) {
  base::Rng rng(80);
  Scene scene;
  const GraspTarget expected = scene.choose().target;
  for (int i = 0; i < 100; ++i) {
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    motion.linear() =
        Eigen::AngleAxisd(3.0 * rng.uniform(), climb_tests::in_box(rng, 1.0).normalized())
            .toRotationMatrix();
    motion.translation() = climb_tests::in_box(rng, 5.0);
    Scene moved;
    for (RungView& rung : moved.rungs) {
      rung.end0_m = motion * rung.end0_m;
      rung.end1_m = motion * rung.end1_m;
    }
    moved.query.T_odom_body = motion * moved.query.T_odom_body;
    moved.query.next_shift_m = motion.linear() * moved.query.next_shift_m;
    moved.query.from_m = motion * moved.query.from_m;
    for (HeldPoint& held : moved.query.held) held.position_m = motion * held.position_m;
    const GraspDecision decision = moved.choose();
    ASSERT_EQ(decision.refusal, Refusal::kNone);
    ASSERT_EQ(decision.target.rung_id, expected.rung_id);
    ASSERT_LE((decision.target.grasp_m - motion * expected.grasp_m).norm(), 1e-9);
  }
}

// More rungs than there is room for are not looked at; every refusal has a name of its own.
TEST(GraspChoice, IsBounded) {
  Scene scene;
  scene.choice = GraspChoice(kParams, 2);
  EXPECT_EQ(scene.choose().rungs.size(), 2U);
  std::set<std::string> names;
  for (int i = 0; i < kNumRefusals; ++i) names.insert(name(static_cast<Refusal>(i)));
  EXPECT_EQ(names.size(), static_cast<std::size_t>(kNumRefusals));
  EXPECT_EQ(name(static_cast<Refusal>(200)), std::string("?"));
}

}  // namespace
}  // namespace climb
