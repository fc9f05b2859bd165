// SPDX-License-Identifier: BSD-3-Clause
// Statics of the hanging robot: guards for few contacts, known cases of the simulated robot, what a
// broken rung leaves.
#include <gtest/gtest.h>

#include "climb/step_order.h"
#include "tests/climb/robot_poses.h"

namespace climb {
namespace {

using climb_tests::hanging_stance;
using climb_tests::kNan;
using climb_tests::stance_at;

const ClimbParams kParams;
const Support kSupport(kParams.robot, kParams.support);

Eigen::Vector3d total(const ContactForces& forces) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& force : forces.force_N) sum += force;
  return sum;
}

Stance with_only(Stance stance, std::initializer_list<Leg> holding) {
  for (Contact& contact : stance.contacts) contact.weight = 0.0;
  for (const Leg leg : holding) stance.contacts[leg].weight = 1.0;
  return stance;
}

// Nothing holds: no forces, the whole weight is told as missing, nothing survives.
TEST(Support, OfNoContactIsGuarded) {
  const Stance stance = with_only(hanging_stance(kParams), {});
  const ContactForces forces = kSupport.distribute(stance);
  EXPECT_EQ(total(forces), Eigen::Vector3d::Zero());
  EXPECT_NEAR(forces.force_residual_N, 78.48, 1e-9);
  EXPECT_EQ(kSupport.check(stance).burden, Burden::kNoContact);
  EXPECT_EQ(kSupport.check(stance).margin, 0.0);
  EXPECT_FALSE(kSupport.check_rung_loss(stance).survives);
}

// One or two contacts give finite forces that leave a moment, and are judged unbalanced.
TEST(Support, OfOneOrTwoContactsTellsTheMomentLeft) {
  for (const auto& holding :
       {std::initializer_list<Leg>{kFrontLeft}, std::initializer_list<Leg>{kFrontLeft, kFrontRight},
        std::initializer_list<Leg>{kRearLeft, kRearRight}}) {
    const Stance stance = with_only(hanging_stance(kParams), holding);
    const ContactForces forces = kSupport.distribute(stance);
    EXPECT_EQ(forces.num_contacts, static_cast<int>(holding.size()));
    EXPECT_TRUE(total(forces).allFinite());
    EXPECT_GT(forces.moment_residual_Nm, 5.0);
    EXPECT_EQ(kSupport.check(stance).burden, Burden::kUnbalanced);
  }
}

// Odd input is refused as such, and gives zero forces and torques.
TEST(Support, RefusesWhatIsNotFinite) {
  Stance odd = hanging_stance(kParams);
  odd.angles_rad[kRearLeft][1] = kNan;
  EXPECT_EQ(kSupport.check(odd).burden, Burden::kNotFinite);
  EXPECT_EQ(total(kSupport.distribute(odd)), Eigen::Vector3d::Zero());
  odd = hanging_stance(kParams);
  odd.up_body = Eigen::Vector3d::Zero();
  EXPECT_EQ(kSupport.check(odd).burden, Burden::kNotFinite);
  odd = hanging_stance(kParams);
  odd.contacts[kFrontLeft].weight = kNan;
  EXPECT_EQ(kSupport.check(odd).burden, Burden::kNotFinite);
  odd = hanging_stance(kParams);
  odd.contacts[kFrontLeft].rung_axis_body.setConstant(kNan);
  EXPECT_EQ(kSupport.check(odd).burden, Burden::kNotFinite);
}

// Hanging on four claws: each bears a quarter of the weight, the fronts are pulled out of the
// ladder and the rears pressed against it, by 16 N each in the simulated robot.
TEST(Support, OfFourClawsIsThatOfTheSimulatedRobot) {
  const SupportVerdict verdict = kSupport.check(hanging_stance(kParams));
  EXPECT_EQ(verdict.burden, Burden::kBorne);
  EXPECT_GE(verdict.margin, 1.3);
  EXPECT_FALSE(verdict.bounded);
  for (const Leg leg : kLegs) {
    const Eigen::Vector3d& force = verdict.forces.force_N[leg];
    EXPECT_NEAR(force.x(), 78.48 / 4.0, 0.5);
    EXPECT_NEAR(force.z(), is_front(leg) ? -16.0 : 16.0, 3.0) << name(leg);
  }
  EXPECT_NEAR(total(verdict.forces).x(), 78.48, 1e-9);
}

// Forces and moments balance for every three claws of random stances, and the limits of the robot
// leave the margin that was found for it: torque below 15 Nm, claws below 65 N.
TEST(Support, OfThreeClawsIsWithinTheLimits) {
  base::Rng rng(60);
  for (int i = 0; i < 400; ++i) {
    const double phase = climb_tests::between(rng, -0.075, 0.075);
    const Stance stance =
        stance_at(kParams, {0.3 + phase, 0.3 + phase, -0.3 + phase, -0.3 + phase}, {3, 3, 1, 1});
    const Leg lifted = kLegs[i % kNumLegs];
    const SupportVerdict verdict = kSupport.check_without(stance, lifted);
    ASSERT_EQ(verdict.burden, Burden::kBorne) << name(verdict.burden);
    ASSERT_GE(verdict.margin, kParams.support.min_margin);
    ASSERT_LE(verdict.forces.moment_residual_Nm, 1e-9);
    ASSERT_LE((total(verdict.forces) - Eigen::Vector3d(78.48, 0, 0)).norm(), 1e-9);
    ASSERT_EQ(verdict.forces.force_N[lifted], Eigen::Vector3d::Zero());
    for (const Leg leg : kLegs) ASSERT_LE(verdict.forces.force_N[leg].norm(), 65.0);
    for (const LegAngles& torques : kSupport.torques_Nm(stance, verdict.forces)) {
      ASSERT_LE(torques.cwiseAbs().maxCoeff(), 15.0);
    }
  }
}

// tau = -J^T f: turning a joint a little against its torque does the work of the contact force.
TEST(Support, TorquesDoTheWorkOfTheForces) {
  const LegKinematics kinematics(kParams.robot);
  const Stance stance = hanging_stance(kParams);
  const ContactForces forces = kSupport.distribute(stance);
  const PerLeg<LegAngles> torques = kSupport.torques_Nm(stance, forces);
  for (const Leg leg : kLegs) {
    for (int joint = 0; joint < kNumLegJoints; ++joint) {
      const LegAngles turn = 1e-6 * LegAngles::Unit(joint);
      const Eigen::Vector3d way = kinematics.foot_m(leg, stance.angles_rad[leg] + turn) -
                                  kinematics.foot_m(leg, stance.angles_rad[leg] - turn);
      EXPECT_NEAR(torques[leg][joint] * 2e-6, -forces.force_N[leg].dot(way), 1e-11);
    }
  }
}

// As a limb's weight falls to zero its force goes to zero without a jump, and the others take over.
TEST(Support, UnloadsWithoutAJump) {
  Stance stance = hanging_stance(kParams);
  ContactForces last = kSupport.distribute(stance);
  for (int i = 1; i <= 100; ++i) {
    stance.contacts[kFrontRight].weight = 1.0 - 0.01 * i;
    const ContactForces forces = kSupport.distribute(stance);
    for (const Leg leg : kLegs) {
      ASSERT_LE((forces.force_N[leg] - last.force_N[leg]).norm(), 1.5) << i;
    }
    last = forces;
  }
  EXPECT_EQ(last.force_N[kFrontRight], Eigen::Vector3d::Zero());
  EXPECT_NEAR(last.moment_residual_Nm, 0.0, 1e-9);
}

// Where the least forces overload a joint, forces within the limits are found when there are any.
TEST(Support, FindsBoundedForcesWhereTheLeastOnesAreTooMuch) {
  Stance stance = with_only(hanging_stance(kParams), {kFrontLeft, kRearLeft, kRearRight});
  const ContactForces least = kSupport.distribute(stance);
  double most_Nm = 0.0;
  for (const LegAngles& torques : kSupport.torques_Nm(stance, least)) {
    most_Nm = std::max(most_Nm, torques.cwiseAbs().maxCoeff());
  }
  ClimbParams weak = kParams;
  weak.support.min_margin = 1.0;
  for (JointLimits* joint : {&weak.robot.abduction, &weak.robot.hip, &weak.robot.knee_bend}) {
    joint->max_torque_Nm = 0.975 * most_Nm;
  }
  const SupportVerdict verdict = Support(weak.robot, weak.support).check(stance);
  EXPECT_TRUE(verdict.bounded);
  EXPECT_GE(verdict.margin, 0.995) << name(verdict.burden);
  EXPECT_LE(verdict.forces.moment_residual_Nm, 1e-6);
}

// Drives too weak for any forces are told: less than margin 1, and which gives way.
TEST(Support, TellsWhatGivesWay) {
  ClimbParams weak = kParams;
  weak.robot.hip.max_torque_Nm = 0.5;
  EXPECT_EQ(Support(weak.robot, weak.support).check(hanging_stance(kParams)).burden,
            Burden::kTorque);
  ClimbParams soft = kParams;
  soft.support.grip_alarm_N = 10.0;
  EXPECT_EQ(Support(soft.robot, soft.support).check(hanging_stance(kParams)).burden, Burden::kGrip);
  // Three quarters of what is needed are not enough.
  const double margin = Support(soft.robot, soft.support).check(hanging_stance(kParams)).margin;
  soft.support.grip_alarm_N *= 0.75 / margin;
  const SupportVerdict nearly = Support(soft.robot, soft.support).check(hanging_stance(kParams));
  EXPECT_NEAR(nearly.margin, 0.75, 0.01);
  EXPECT_EQ(nearly.burden, Burden::kGrip);
  ClimbParams slippery = kParams;
  slippery.support.squeeze_N = 0.1;
  slippery.support.friction = 0.01;
  Stance leaning = hanging_stance(kParams);  // the ladder leans sideways: rungs bear along
  leaning.up_body = Eigen::Vector3d(std::cos(0.3), std::sin(0.3), 0.0);
  EXPECT_EQ(Support(slippery.robot, slippery.support).check(leaning).burden, Burden::kFriction);
}

struct LossCase {
  const char* what;
  PerLeg<int> rungs;  ///< 0 = this leg is swinging
  bool survives;
};

// What was seen when rungs broke under the simulated robot.
TEST(RungLoss, IsWhatTheSimulatedRobotDid) {
  const LossCase cases[] = {
      {"four claws on four rungs", {3, 4, 1, 2}, true},
      {"fronts share a rung, rears share a rung", {3, 3, 1, 1}, false},
      {"fronts share a rung, rears do not", {3, 3, 1, 2}, false},
      {"rears share a rung, fronts do not", {3, 4, 1, 1}, true},
      {"FR swings: the rung of FL breaks", {3, 0, 1, 2}, false},
      {"RL swings, three rungs", {3, 4, 0, 2}, true},
      {"RR swings, fronts share a rung", {3, 3, 1, 0}, false},
  };
  for (const LossCase& c : cases) {
    Stance stance = hanging_stance(kParams);
    for (const Leg leg : kLegs) {
      const double rung = c.rungs[leg] != 0 ? c.rungs[leg] : (is_front(leg) ? 3.5 : 1.5);
      const double along_m = 0.3 * rung - 0.3 * 2.5;
      Stance placed = stance_at(kParams, {along_m, along_m, along_m, along_m}, c.rungs);
      stance.angles_rad[leg] = placed.angles_rad[leg];
      stance.contacts[leg].rung_id = c.rungs[leg];
      stance.contacts[leg].weight = c.rungs[leg] != 0 ? 1.0 : 0.0;
    }
    const RungLoss loss = kSupport.check_rung_loss(stance);
    EXPECT_EQ(loss.survives, c.survives) << c.what << ": rung " << loss.worst_rung_id << " leaves "
                                         << loss.num_remaining << ", margin " << loss.margin;
  }
}

}  // namespace
}  // namespace climb
