// SPDX-License-Identifier: BSD-3-Clause
// Leg odometry: odd inputs, no drift while feet hold, equivariance, slip, errors that grow.
#include "climb/odometry.h"

#include <gtest/gtest.h>

#include "tests/climb/robot_poses.h"

namespace climb {
namespace {

using climb_tests::kNan;

/// Claws that hold a rung at the foot's point: that point stays.
ClimbParams pinned_feet() {
  ClimbParams params;
  params.robot.claw.seat_up_m = params.robot.claw.seat_out_m = 0.0;
  return params;
}

const ClimbParams kParams = pinned_feet();
const LegKinematics kKinematics(kParams.robot);

Eigen::Quaterniond random_rotation(base::Rng& rng, double most_rad) {
  const Eigen::Vector3d axis = climb_tests::in_box(rng, 1.0).normalized();
  return Eigen::Quaterniond(
      Eigen::AngleAxisd(climb_tests::between(rng, -most_rad, most_rad), axis));
}

/// Angles that put each foot on its odom point for a body at this pose.
OdometryInput input_at(const PerLeg<Eigen::Vector3d>& feet_odom_m, const Eigen::Vector3d& body_m,
                       const Eigen::Quaterniond& q_odom_body) {
  OdometryInput input;
  input.q_odom_body = q_odom_body;
  for (const Leg leg : kLegs) {
    const LegSolution solution =
        kKinematics.inverse(leg, q_odom_body.conjugate() * (feet_odom_m[leg] - body_m));
    EXPECT_TRUE(solution.reachable()) << name(leg);
    input.angles_rad[leg] = solution.angles_rad;
    input.weight[leg] = 1.0;
  }
  return input;
}

/// The feet of the robot at the origin, turned by q.
PerLeg<Eigen::Vector3d> feet_of(const Eigen::Quaterniond& q_odom_body) {
  const Stance stance = climb_tests::hanging_stance(kParams);
  PerLeg<Eigen::Vector3d> feet;
  for (const Leg leg : kLegs) {
    feet[leg] = q_odom_body * kKinematics.foot_m(leg, stance.angles_rad[leg]);
  }
  return feet;
}

// The first fix is the origin; input that is no number changes no pose but makes it less certain.
TEST(Odometry, FirstFixAndOddInput) {
  Odometry odometry(kParams.robot, kParams.odometry);
  OdometryInput odd = input_at(feet_of(Eigen::Quaterniond::Identity()), Eigen::Vector3d::Zero(),
                               Eigen::Quaterniond::Identity());
  odd.q_odom_body.coeffs().setZero();
  odometry.update(odd);
  EXPECT_FALSE(odometry.fixed());
  const OdometryInput good = input_at(feet_of(Eigen::Quaterniond::Identity()),
                                      Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity());
  odometry.update(good);
  EXPECT_TRUE(odometry.fixed());
  EXPECT_EQ(odometry.estimate().position_odom_m, Eigen::Vector3d::Zero());
  const double sigma_m = odometry.estimate().position_sigma_m;
  for (int kind = 0; kind < 5; ++kind) {
    OdometryInput bad = good;
    if (kind == 0) bad.angles_rad[kRearLeft][2] = kNan;
    if (kind == 1) bad.weight[kRearLeft] = kNan;
    if (kind == 2) bad.weight[kRearLeft] = 1.5;
    if (kind == 3) bad.q_odom_body.w() = kNan;
    if (kind == 4) bad.q_odom_body.coeffs() *= 2.0;
    odometry.update(bad);
    EXPECT_EQ(odometry.estimate().position_odom_m, Eigen::Vector3d::Zero());
  }
  EXPECT_GT(odometry.estimate().position_sigma_m, sigma_m);
  OdometryInput timeless = good;
  timeless.dt_s = kNan;
  odometry.update(timeless);
  EXPECT_TRUE(std::isfinite(odometry.estimate().position_sigma_m));
}

// While the feet hold, the body is where it is, however long and however it moves: no drift.
TEST(Odometry, DoesNotDriftWhileFeetHold) {
  base::Rng rng(70);
  const Eigen::Quaterniond upright(Eigen::AngleAxisd(-M_PI / 2, Eigen::Vector3d::UnitY()));
  const PerLeg<Eigen::Vector3d> feet = feet_of(upright);
  Odometry odometry(kParams.robot, kParams.odometry);
  odometry.update(input_at(feet, Eigen::Vector3d::Zero(), upright));
  double sigma_m = 0.0;
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector3d body = climb_tests::in_box(rng, 0.03);
    const Eigen::Quaterniond q = upright * random_rotation(rng, 0.05);
    const OdometryEstimate& estimate = odometry.update(input_at(feet, body, q));
    ASSERT_LE((estimate.position_odom_m - body).norm(), 1e-12);
    ASSERT_EQ(estimate.num_feet, 4);
    ASSERT_FALSE(estimate.slipped);
    if (i == 0) sigma_m = estimate.position_sigma_m;
    ASSERT_DOUBLE_EQ(estimate.position_sigma_m, sigma_m);
  }
  EXPECT_LT(sigma_m, 0.003);
}

// Seen from a turned odom frame, everything is the same, turned.
TEST(Odometry, IsEquivariant) {
  base::Rng rng(71);
  for (int run = 0; run < 50; ++run) {
    const Eigen::Quaterniond turn = random_rotation(rng, M_PI);
    Odometry one(kParams.robot, kParams.odometry);
    Odometry other(kParams.robot, kParams.odometry);
    for (int i = 0; i < 40; ++i) {
      OdometryInput input;
      input.q_odom_body = random_rotation(rng, M_PI);
      for (const Leg leg : kLegs) {
        input.angles_rad[leg] = climb_tests::random_angles(rng, kKinematics, leg);
        input.weight[leg] = rng.below(3) == 0 ? 0.0 : rng.uniform();
      }
      OdometryInput turned = input;
      turned.q_odom_body = turn * input.q_odom_body;
      const OdometryEstimate& a = one.update(input);
      const OdometryEstimate& b = other.update(turned);
      ASSERT_LE((turn * a.position_odom_m - b.position_odom_m).norm(), 1e-9);
      ASSERT_EQ(a.slipped, b.slipped);
      ASSERT_NEAR(a.position_sigma_m, b.position_sigma_m, 1e-12);
    }
  }
}

// A free foot takes no part, whatever it does; held again it takes the place where it then is, and
// the error has grown by one hold.
TEST(Odometry, AFreeFootTakesNoPart) {
  const Eigen::Quaterniond level = Eigen::Quaterniond::Identity();
  PerLeg<Eigen::Vector3d> feet = feet_of(level);
  Odometry odometry(kParams.robot, kParams.odometry);
  odometry.update(input_at(feet, Eigen::Vector3d::Zero(), level));
  odometry.update(input_at(feet, Eigen::Vector3d::Zero(), level));
  const double sigma_m = odometry.estimate().position_sigma_m;
  feet[kRearRight].x() += 0.1;
  OdometryInput swinging = input_at(feet, Eigen::Vector3d(0.02, 0.0, 0.0), level);
  swinging.weight[kRearRight] = 0.0;
  odometry.update(swinging);
  EXPECT_NEAR(odometry.estimate().position_odom_m.x(), 0.02, 1e-12);
  EXPECT_FALSE(odometry.anchor_m(kRearRight));
  const OdometryInput held = input_at(feet, Eigen::Vector3d(0.02, 0.0, 0.0), level);
  odometry.update(held);
  odometry.update(held);
  EXPECT_LE((*odometry.anchor_m(kRearRight) - feet[kRearRight]).norm(), 1e-12);
  EXPECT_NEAR(odometry.estimate().position_odom_m.x(), 0.02, 1e-12);
  EXPECT_GT(odometry.estimate().position_sigma_m, sigma_m);
}

// Claws whose shanks turn keep their rungs where they are: what stays is the rung's axis in the
// settled claw and not the foot's point.
TEST(Odometry, ARungStaysWhereTheShankTurns) {
  const ClimbParams params;
  const LegKinematics kinematics(params.robot);
  const Eigen::Quaterniond upright(Eigen::AngleAxisd(-M_PI / 2, Eigen::Vector3d::UnitY()));
  const Stance stance = climb_tests::hanging_stance(params);
  PerLeg<Eigen::Vector3d> rungs_m;
  for (const Leg leg : kLegs) {
    rungs_m[leg] = upright * kinematics.seat_m(leg, stance.angles_rad[leg]);
  }
  Odometry odometry(params.robot, params.odometry);
  OdometryInput input;
  input.q_odom_body = upright;
  input.angles_rad = stance.angles_rad;
  input.weight = {1.0, 1.0, 1.0, 1.0};
  odometry.update(input);
  const Eigen::Vector3d risen_m(0.0, 0.0, 0.08);
  for (const Leg leg : kLegs) {
    // The foot for which the claw has its rung, by iteration: the claw turns as the leg moves.
    Eigen::Vector3d foot_m = kinematics.foot_m(leg, stance.angles_rad[leg]);
    for (int i = 0; i < 50; ++i) {
      input.angles_rad[leg] = kinematics.inverse(leg, foot_m).angles_rad;
      const Eigen::Vector3d wanted_m = upright.conjugate() * (rungs_m[leg] - risen_m);
      foot_m += wanted_m - kinematics.seat_m(leg, input.angles_rad[leg]);
    }
  }
  EXPECT_LE((odometry.update(input).position_odom_m - risen_m).norm(), 1e-9);
}

// A new claw that slides down its rung does not take the body's place with it; one that has borne
// the steps of two others does count.
TEST(Odometry, ANewFootSettlesWithoutMovingTheBody) {
  const Eigen::Quaterniond level = Eigen::Quaterniond::Identity();
  PerLeg<Eigen::Vector3d> feet = feet_of(level);
  const Eigen::Vector3d here = Eigen::Vector3d::Zero();
  Odometry odometry(kParams.robot, kParams.odometry);
  odometry.update(input_at(feet, here, level));
  const auto step = [&](Leg leg) {
    OdometryInput swinging = input_at(feet, here, level);
    swinging.weight[leg] = 0.0;
    odometry.update(swinging);
    odometry.update(input_at(feet, here, level));
  };
  const auto slide = [&](Leg leg, double by_m) {
    for (int i = 0; i < 300; ++i) {
      feet[leg].x() += by_m / 300.0;
      odometry.update(input_at(feet, here, level));
    }
    return odometry.estimate().position_odom_m.norm();
  };
  step(kRearRight);
  EXPECT_LE(slide(kRearRight, 0.006), 0.0002);
  step(kFrontRight);
  EXPECT_LE(slide(kRearRight, 0.004), 0.0002);
  step(kRearLeft);
  EXPECT_GE(slide(kRearRight, 0.006), 0.001);
}

// A foot that slips while it is said to hold is named; small disagreement is not.
TEST(Odometry, NamesTheFootThatSlips) {
  const Eigen::Quaterniond level = Eigen::Quaterniond::Identity();
  for (const Leg slipping : kLegs) {
    PerLeg<Eigen::Vector3d> feet = feet_of(level);
    Odometry odometry(kParams.robot, kParams.odometry);
    odometry.update(input_at(feet, Eigen::Vector3d::Zero(), level));
    feet[slipping].y() += 0.004;
    odometry.update(input_at(feet, Eigen::Vector3d::Zero(), level));
    EXPECT_FALSE(odometry.estimate().slipped);
    feet[slipping].y() += 0.016;
    odometry.update(input_at(feet, Eigen::Vector3d::Zero(), level));
    EXPECT_EQ(odometry.estimate().slipped, slipping);
  }
}

// While no foot holds the body is kept where it was and the error grows with time.
TEST(Odometry, WithoutFeetOnlyTheErrorGrows) {
  const Eigen::Quaterniond level = Eigen::Quaterniond::Identity();
  Odometry odometry(kParams.robot, kParams.odometry);
  OdometryInput input = input_at(feet_of(level), Eigen::Vector3d::Zero(), level);
  odometry.update(input);
  input.weight = {0.0, 0.0, 0.0, 0.0};
  for (int i = 0; i < 100; ++i) odometry.update(input);
  EXPECT_EQ(odometry.estimate().position_odom_m, Eigen::Vector3d::Zero());
  EXPECT_NEAR(odometry.estimate().position_sigma_m, 0.5, 0.01);
  EXPECT_EQ(odometry.estimate().num_feet, 0);
}

// As a foot's weight fades out the pose moves smoothly, even when the feet disagree.
TEST(Odometry, AFadingFootMovesNothingSuddenly) {
  const Eigen::Quaterniond level = Eigen::Quaterniond::Identity();
  PerLeg<Eigen::Vector3d> feet = feet_of(level);
  Odometry odometry(kParams.robot, kParams.odometry);
  odometry.update(input_at(feet, Eigen::Vector3d::Zero(), level));
  feet[kFrontLeft].z() += 0.006;  // settled in its claw
  OdometryInput input = input_at(feet, Eigen::Vector3d::Zero(), level);
  Eigen::Vector3d last = odometry.update(input).position_odom_m;
  for (int i = 0; i <= 30; ++i) {
    input.weight[kFrontLeft] = 1.0 - i / 30.0;
    const Eigen::Vector3d here = odometry.update(input).position_odom_m;
    ASSERT_LE((here - last).norm(), 0.0001);
    last = here;
  }
}

// reset() forgets everything.
TEST(Odometry, ResetBeginsAgain) {
  const Eigen::Quaterniond level = Eigen::Quaterniond::Identity();
  const PerLeg<Eigen::Vector3d> feet = feet_of(level);
  Odometry odometry(kParams.robot, kParams.odometry);
  odometry.update(input_at(feet, Eigen::Vector3d::Zero(), level));
  odometry.update(input_at(feet, Eigen::Vector3d(0.02, 0.0, 0.0), level));
  odometry.reset();
  EXPECT_FALSE(odometry.fixed());
  EXPECT_FALSE(odometry.anchor_m(kFrontLeft));
  odometry.update(input_at(feet, Eigen::Vector3d(0.02, 0.0, 0.0), level));
  EXPECT_EQ(odometry.estimate().position_odom_m, Eigen::Vector3d::Zero());
}

}  // namespace
}  // namespace climb
