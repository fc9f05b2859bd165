// SPDX-License-Identifier: BSD-3-Clause
// Leg kinematics against KDL, which knows nothing of our formulas: a chain of joints and frames.
#include <gtest/gtest.h>

#include "tests/climb/kdl_leg.h"
#include "tests/climb/robot_poses.h"

namespace climb {
namespace {

using kdl_leg::KdlLeg;
using kdl_leg::Triple;

constexpr int kNumPoses = 10000;
const RobotParams kRobot;
const LegKinematics kKinematics(kRobot);

Triple triple(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}
Eigen::Vector3d vector(const Triple& t) {
  return {t[0], t[1], t[2]};
}

KdlLeg kdl_of(Leg leg) {
  kdl_leg::Shape shape;
  shape.hip_m = {lengthwise_sign(leg) * kRobot.hip_x_m, lateral_sign(leg) * kRobot.hip_y_m, 0.0};
  shape.side_m = lateral_sign(leg) * kRobot.abduction_m;
  shape.thigh_m = kRobot.thigh_m;
  shape.shank_m = kRobot.shank_m;
  shape.claw_rad = -lengthwise_sign(leg) * kRobot.wrist_rad;
  return KdlLeg(shape);
}

// Foot, claw axes and Jacobian agree with KDL's chain in 1e4 poses of each leg.
TEST(KinematicsAgainstKdl, ForwardAndJacobianAgree) {
  base::Rng rng(10);
  for (const Leg leg : kLegs) {
    const KdlLeg kdl = kdl_of(leg);
    for (int i = 0; i < kNumPoses; ++i) {
      const LegAngles q = climb_tests::random_angles(rng, kKinematics, leg);
      const kdl_leg::Pose pose = kdl.forward(triple(q));
      ASSERT_LE((vector(pose.foot_m) - kKinematics.foot_m(leg, q)).norm(), 1e-14);
      const auto columns = kdl.jacobian(triple(q));
      const Eigen::Matrix3d jacobian = kKinematics.jacobian(leg, q);
      const Eigen::Matrix3d claw = kKinematics.R_body_claw(leg, q);
      for (int k = 0; k < 3; ++k) {
        ASSERT_LE((vector(columns[k]) - jacobian.col(k)).norm(), 1e-14);
        ASSERT_LE((vector(pose.claw_axes[k]) - claw.col(k)).norm(), 1e-14);
      }
    }
  }
}

// KDL's numeric solver, started in one posture per leg, reaches the same feet; where it ends within
// our limits its angles are ours (1e4 feet).
TEST(KinematicsAgainstKdl, InverseAgrees) {
  base::Rng rng(11);
  int num_solved = 0;
  int num_same_branch = 0;
  for (const Leg leg : kLegs) {
    const KdlLeg kdl = kdl_of(leg);
    const double bend = kRobot.knee_sign[leg];
    const Triple start = {0.0, -0.6 * bend, 1.2 * bend};
    for (int i = 0; i < kNumPoses / kNumLegs; ++i) {
      const LegAngles q = climb_tests::random_pose(rng, kRobot, kKinematics, leg);
      const Eigen::Vector3d foot = kKinematics.foot_m(leg, q);
      const LegSolution ours = kKinematics.inverse(leg, foot);
      ASSERT_TRUE(ours.reachable());
      Triple found{};
      if (!kdl.inverse(triple(foot), start, found)) continue;
      ++num_solved;
      ASSERT_LE((vector(kdl.forward(found).foot_m) - foot).norm(), 1e-9);
      const LegAngles theirs = vector(found);
      if (!(kKinematics.limit_margin_rad(leg, theirs) >= 0.0)) continue;
      if (!(climb_tests::depth_m(kRobot, theirs) > 0.0)) continue;
      ++num_same_branch;
      ASSERT_LE((theirs - ours.angles_rad).cwiseAbs().maxCoeff(), 1e-6);
    }
  }
  EXPECT_GE(num_solved, kNumPoses * 95 / 100);
  EXPECT_GE(num_same_branch, kNumPoses / 2);
  RecordProperty("solved_by_kdl", num_solved);
  RecordProperty("same_branch", num_same_branch);
}

}  // namespace
}  // namespace climb
