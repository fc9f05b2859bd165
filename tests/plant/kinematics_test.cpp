// SPDX-License-Identifier: BSD-3-Clause
// The plant's kinematics against chains of homogeneous transforms, finite differences, and the
// controller's analytic solution, which was written independently.
#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "base/rng.h"
#include "climb/leg_kinematics.h"
#include "simulator/plant/body_pose.h"
#include "simulator/plant/plant_kinematics.h"

namespace simulator {
namespace {

LegAngles random_angles(base::Rng& rng, int leg) {
  return {rng.uniform() * 1.8 - 0.9, rng.uniform() * 5.2 - 2.6,
          forward_sign(leg) * (0.15 + rng.uniform() * 2.55)};
}

/// Link by link, as a textbook would.
Eigen::Vector3d chained_foot(const RobotGeometry& g, int leg, const LegAngles& q) {
  using Eigen::AngleAxisd;
  using Eigen::Translation3d;
  using Eigen::Vector3d;
  const Eigen::Isometry3d chain =
      Translation3d(forward_sign(leg) * g.hip_x_m, left_sign(leg) * g.hip_y_m, 0.0) *
      AngleAxisd(q[0], Vector3d::UnitX()) *
      Translation3d(0.0, left_sign(leg) * g.abduction_m, 0.0) *
      AngleAxisd(q[1], Vector3d::UnitY()) * Translation3d(0.0, 0.0, -g.thigh_m) *
      AngleAxisd(q[2], Vector3d::UnitY()) * Translation3d(0.0, 0.0, -g.shank_m);
  return chain.translation();
}

// Forward kinematics equal the product of the links' transforms, for every leg.
TEST(PlantKinematics, EqualsChainOfTransforms) {
  base::Rng rng(1);
  const RobotGeometry geometry;
  for (int i = 0; i < 4000; ++i) {
    const int leg = i % kNumLegs;
    const LegAngles q = random_angles(rng, leg);
    const Eigen::Vector3d error = foot_in_body(geometry, leg, q) - chained_foot(geometry, leg, q);
    ASSERT_LT(error.norm(), 1e-13);
  }
}

// The Jacobian equals central differences.
TEST(PlantKinematics, JacobianEqualsDifferences) {
  base::Rng rng(2);
  const RobotGeometry geometry;
  for (int i = 0; i < 400; ++i) {
    const int leg = i % kNumLegs;
    const LegAngles q = random_angles(rng, leg);
    const Eigen::Matrix3d jacobian = foot_jacobian(geometry, leg, q);
    for (int joint = 0; joint < 3; ++joint) {
      LegAngles more = q, less = q;
      more[joint] += 1e-6;
      less[joint] -= 1e-6;
      const Eigen::Vector3d slope =
          (foot_in_body(geometry, leg, more) - foot_in_body(geometry, leg, less)) / 2e-6;
      ASSERT_LT((jacobian.col(joint) - slope).norm(), 1e-8);
    }
  }
}

// The controller and the plant mean the same robot: same foot for the same angles.
TEST(PlantKinematics, AgreesWithTheController) {
  base::Rng rng(3);
  const climb::LegKinematics controller{climb::RobotParams{}};
  for (int i = 0; i < 4000; ++i) {
    const int leg = i % kNumLegs;
    const LegAngles q = random_angles(rng, leg);
    const Eigen::Vector3d theirs = controller.foot_m(static_cast<climb::Leg>(leg), q);
    ASSERT_LT((foot_in_body(RobotGeometry{}, leg, q) - theirs).norm(), 1e-12);
  }
}

// The iterative inverse reaches the places that a climb needs; what is too far is refused.
TEST(PlantKinematics, InverseReachesTheRungs) {
  const RobotGeometry geometry;
  for (int leg = 0; leg < kNumLegs; ++leg) {
    for (double x = -0.25; x <= 0.251; x += 0.05) {
      const Eigen::Vector3d foot(forward_sign(leg) * 0.25 + x, left_sign(leg) * 0.15, -0.28);
      const auto angles = angles_for_foot(geometry, leg, foot);
      ASSERT_TRUE(angles) << leg << " " << x;
      EXPECT_LT((foot_in_body(geometry, leg, *angles) - foot).norm(), 1e-9);
    }
    EXPECT_FALSE(angles_for_foot(geometry, leg, {2.0, 0.0, -0.28}));
  }
}

// Points moved rigidly give back exactly that motion.
TEST(BodyPose, FindsTheRigidMotion) {
  base::Rng rng(4);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d axis(rng.gaussian(), rng.gaussian(), rng.gaussian());
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = Eigen::AngleAxisd(rng.uniform() * 3.0, axis.normalized()).toRotationMatrix();
    pose.translation() = Eigen::Vector3d(rng.gaussian(), rng.gaussian(), rng.gaussian());
    std::array<Support, 4> supports;
    for (Support& support : supports) {
      support.p_body_m = {rng.gaussian(), rng.gaussian(), rng.gaussian()};
      support.p_world_m = pose * support.p_body_m;
      support.stiffness_N_m = 1e4;
    }
    const Eigen::Isometry3d found = balanced_pose(supports, pose);
    ASSERT_LT((found.matrix() - pose.matrix()).norm(), 1e-9);
  }
}

// Without any support the body stays where it was.
TEST(BodyPose, FreeDirectionsStay) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(-0.28, 0.0, 0.6);
  EXPECT_LT((balanced_pose({}, pose).matrix() - pose.matrix()).norm(), 1e-12);
}

// The shares balance force and moment whenever three or four feet can; none without feet.
TEST(BodyPose, SharesBalanceTheWeight) {
  EXPECT_TRUE(weight_shares({}, Eigen::Vector3d::Zero(), 80.0).empty());
  const std::array<Eigen::Vector3d, 4> feet = {
      Eigen::Vector3d{0.0, 0.15, 0.9}, {0.0, -0.15, 1.2}, {0.0, 0.15, 0.3}, {0.0, -0.15, 0.6}};
  const Eigen::Vector3d centre(-0.28, 0.0, 0.7);
  for (std::size_t num = 3; num <= 4; ++num) {
    const auto forces = weight_shares({feet.data(), num}, centre, 80.0);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < num; ++i) {
      sum += forces[i];
      moment += (feet[i] - centre).cross(forces[i]);
    }
    EXPECT_LT((sum - Eigen::Vector3d(0, 0, 80)).norm(), 1e-9);
    EXPECT_LT(moment.norm(), 1e-9);
  }
}

}  // namespace
}  // namespace simulator
