// SPDX-License-Identifier: BSD-3-Clause
// Leg kinematics: odd inputs, reasons of refusal, round trips, Jacobian, claw.
#include <gtest/gtest.h>

#include "climb/leg_kinematics.h"
#include "climb/mass_model.h"
#include "tests/climb/robot_poses.h"

namespace climb {
namespace {

using climb_tests::kInfinity;
using climb_tests::kNan;
using climb_tests::random_angles;
using climb_tests::random_pose;

const RobotParams kRobot;
const LegKinematics kKinematics(kRobot);

// A point that is not finite is refused as such, in every coordinate.
TEST(LegKinematics, RefusesWhatIsNotFinite) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double odd : {kNan, kInfinity, -kInfinity}) {
      Eigen::Vector3d point(0.3, 0.15, -0.28);
      point[axis] = odd;
      const LegSolution solution = kKinematics.inverse(kFrontLeft, point);
      EXPECT_EQ(solution.reach, Reach::kNotFinite);
      EXPECT_EQ(solution.angles_rad, LegAngles::Zero());
    }
  }
}

// Each way of being out of reach is told by its own reason.
TEST(LegKinematics, TellsWhyAPointIsOutOfReach) {
  const Eigen::Vector3d hip = kKinematics.hip_m(kFrontLeft);
  const auto reach_at = [&](double x, double y, double z) {
    return kKinematics.inverse(kFrontLeft, hip + Eigen::Vector3d(x, y, z)).reach;
  };
  EXPECT_EQ(reach_at(0.0, 0.05, -0.461), Reach::kTooFar);
  EXPECT_EQ(reach_at(1e200, 0.05, -0.3), Reach::kTooFar);
  EXPECT_EQ(reach_at(0.0, 0.05, -0.0199), Reach::kAtHipAxis);
  EXPECT_EQ(reach_at(0.0, 0.0, 0.0), Reach::kAtHipAxis);
  EXPECT_EQ(reach_at(0.0, 0.05, -0.459999), Reach::kKneeLimit);  // all but straight
  EXPECT_EQ(reach_at(0.0, 0.05, 0.3), Reach::kAbductionLimit);   // behind the back
  EXPECT_EQ(reach_at(0.0, 0.4, -0.05), Reach::kAbductionLimit);
  EXPECT_EQ(reach_at(0.0, 0.05, -0.05), Reach::kKneeLimit);  // folded further than it can
  EXPECT_EQ(reach_at(0.0, 0.05, -0.28), Reach::kReachable);
  RobotParams uneven = kRobot;
  uneven.shank_m = 0.1;
  const Eigen::Vector3d folded = hip + Eigen::Vector3d(0.0, 0.05, -0.1);
  EXPECT_EQ(LegKinematics(uneven).inverse(kFrontLeft, folded).reach, Reach::kTooNear);
  RobotParams stiff = kRobot;
  stiff.hip.max_rad = 0.2;
  stiff.hip.min_rad = -0.2;
  EXPECT_EQ(LegKinematics(stiff).inverse(kFrontLeft, hip + Eigen::Vector3d(0.3, 0.05, -0.28)).reach,
            Reach::kHipLimit);
}

// Every pose within the limits, foot on the ladder's side, is found again: same angles, and the
// foot to a nanometre (1e6 poses).
TEST(LegKinematics, InverseOfForwardIsTheSamePose) {
  base::Rng rng(1);
  double worst_m = 0.0;
  double worst_rad = 0.0;
  for (int i = 0; i < 1000000; ++i) {
    const Leg leg = kLegs[i % kNumLegs];
    const LegAngles q = random_pose(rng, kRobot, kKinematics, leg);
    const Eigen::Vector3d foot = kKinematics.foot_m(leg, q);
    const LegSolution solution = kKinematics.inverse(leg, foot);
    // Rounding may put an angle on a limit just outside it.
    if (!solution.reachable() && kKinematics.limit_margin_rad(leg, q) < 1e-9) continue;
    ASSERT_TRUE(solution.reachable())
        << name(leg) << " " << q.transpose() << ": " << name(solution.reach);
    worst_rad = std::max(worst_rad, (solution.angles_rad - q).cwiseAbs().maxCoeff());
    worst_m = std::max(worst_m, (kKinematics.foot_m(leg, solution.angles_rad) - foot).norm());
  }
  EXPECT_LE(worst_m, 1e-9);
  EXPECT_LE(worst_rad, 1e-7);
  RecordProperty("worst_m", std::to_string(worst_m * 1e15) + "e-15");
}

// Any point of space gives either a refusal or angles within the limits that reach it.
TEST(LegKinematics, NeverAnswersOutsideTheLimits) {
  base::Rng rng(2);
  int num_reachable = 0;
  for (int i = 0; i < 200000; ++i) {
    const Leg leg = kLegs[i % kNumLegs];
    const Eigen::Vector3d point = kKinematics.hip_m(leg) + climb_tests::in_box(rng, 0.5);
    const LegSolution solution = kKinematics.inverse(leg, point);
    if (!solution.reachable()) continue;
    ++num_reachable;
    ASSERT_GE(kKinematics.limit_margin_rad(leg, solution.angles_rad), 0.0);
    ASSERT_LE((kKinematics.foot_m(leg, solution.angles_rad) - point).norm(), 1e-9);
  }
  EXPECT_GT(num_reachable, 10000);
}

// The Jacobian is the derivative of the foot.
TEST(LegKinematics, JacobianIsTheDerivative) {
  base::Rng rng(3);
  for (int i = 0; i < 1000; ++i) {
    const Leg leg = kLegs[i % kNumLegs];
    const LegAngles q = random_angles(rng, kKinematics, leg);
    const Eigen::Matrix3d jacobian = kKinematics.jacobian(leg, q);
    for (int joint = 0; joint < kNumLegJoints; ++joint) {
      const LegAngles step = 1e-6 * LegAngles::Unit(joint);
      const Eigen::Vector3d slope =
          (kKinematics.foot_m(leg, q + step) - kKinematics.foot_m(leg, q - step)) / 2e-6;
      ASSERT_LE((jacobian.col(joint) - slope).norm(), 1e-8);
    }
  }
}

// The smallest singular value falls to zero as the knee stretches, and is that of a full SVD.
TEST(LegKinematics, SmallestSingularValueSeesTheStretchedKnee) {
  double last = 1.0;
  for (const double knee_rad : {1.2, 0.8, 0.4, 0.15, 0.01, 0.0}) {
    const double sigma = smallest_singular_value(
        kKinematics.jacobian(kFrontLeft, LegAngles(0.0, -0.5 * knee_rad, knee_rad)));
    EXPECT_LT(sigma, last);
    last = sigma;
  }
  EXPECT_NEAR(last, 0.0, 1e-8);
  Eigen::Matrix3d diagonal = Eigen::Vector3d(0.5, 0.25, 2.0).asDiagonal();
  EXPECT_NEAR(smallest_singular_value(diagonal), 0.25, 1e-12);
}

// Left and right legs mirror each other.
TEST(LegKinematics, RightIsTheMirrorImageOfLeft) {
  base::Rng rng(4);
  for (int i = 0; i < 1000; ++i) {
    const LegAngles q = random_angles(rng, kKinematics, kRearLeft);
    const Eigen::Vector3d left = kKinematics.foot_m(kRearLeft, q);
    const Eigen::Vector3d right = kKinematics.foot_m(kRearRight, LegAngles(-q[0], q[1], q[2]));
    ASSERT_LE((left - Eigen::Vector3d(right.x(), -right.y(), right.z())).norm(), 1e-15);
  }
}

// The claw is a rotation; at rest on the ladder every claw opens towards the ladder, within 35 deg.
TEST(LegKinematics, ClawOpensTowardsTheLadder) {
  base::Rng rng(5);
  for (int i = 0; i < 1000; ++i) {
    const Leg leg = kLegs[i % kNumLegs];
    const Eigen::Matrix3d R = kKinematics.R_body_claw(leg, random_angles(rng, kKinematics, leg));
    ASSERT_LE((R * R.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    ASSERT_NEAR(R.determinant(), 1.0, 1e-14);
  }
  const Stance stance = climb_tests::hanging_stance(ClimbParams());
  for (const Leg leg : kLegs) {
    const Eigen::Vector3d out = kKinematics.retract_direction(leg, stance.angles_rad[leg]);
    EXPECT_GT(out.z(), 0.82) << name(leg) << " " << out.transpose();
  }
}

// Clamping moves a pose onto the limits and no further; a pose inside stays.
TEST(LegKinematics, ClampsOntoTheLimits) {
  const LegAngles clamped = kKinematics.clamped(kRearLeft, LegAngles(9.0, -9.0, 9.0));
  EXPECT_EQ(clamped, LegAngles(0.9, -2.6, -0.15));
  EXPECT_EQ(kKinematics.limit_margin_rad(kRearLeft, clamped), 0.0);
  EXPECT_LT(kKinematics.limit_margin_rad(kRearLeft, LegAngles(0.0, 0.0, 0.5)), 0.0);
  EXPECT_TRUE(std::isnan(kKinematics.limit_margin_rad(kRearLeft, LegAngles(kNan, 0.0, -1.0))));
}

// Mirror-image legs leave the centre of mass in the middle; the mass is that of the real robot.
TEST(MassModel, IsInTheMiddleForMirroredLegs) {
  const MassModel mass(kRobot);
  EXPECT_NEAR(mass.total_kg(), 8.0, 1e-12);
  const Stance stance = climb_tests::hanging_stance(ClimbParams());
  const Eigen::Vector3d center = mass.center_m(stance.angles_rad);
  EXPECT_NEAR(center.x(), 0.0, 1e-12);
  EXPECT_NEAR(center.y(), 0.0, 1e-12);
  EXPECT_LT(center.z(), 0.0);
}

// The centre of mass is the mean of the parts' middles: each found by a kinematic chain that ends
// there (a shorter leg).
TEST(MassModel, IsTheMeanOfTheParts) {
  base::Rng rng(6);
  PerLeg<LegAngles> angles;
  for (const Leg leg : kLegs) angles[leg] = random_angles(rng, kKinematics, leg);
  const auto point_of = [&](Leg leg, double side_m, double thigh_m, double shank_m) {
    RobotParams shorter = kRobot;
    shorter.abduction_m = side_m;
    shorter.thigh_m = thigh_m;
    shorter.shank_m = shank_m;
    return LegKinematics(shorter).foot_m(leg, angles[leg]);
  };
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Leg leg : kLegs) {
    sum += kRobot.mass.abduction_kg * point_of(leg, 0.025, 0.0, 0.0) +
           kRobot.mass.thigh_kg * point_of(leg, 0.05, 0.11, 0.0) +
           kRobot.mass.shank_kg * point_of(leg, 0.05, 0.22, 0.12) +
           kRobot.mass.claw_kg * point_of(leg, 0.05, 0.22, 0.24);
  }
  EXPECT_LE((MassModel(kRobot).center_m(angles) - sum / 8.0).norm(), 1e-14);
}

}  // namespace
}  // namespace climb
