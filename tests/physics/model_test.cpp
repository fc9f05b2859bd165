// SPDX-License-Identifier: BSD-3-Clause
// robot.xml is the robot that the controller believes in, and it hangs on a ladder by its claws.
#include <gtest/gtest.h>

#include "base/rng.h"
#include "climb/leg_kinematics.h"
#include "simulator/physics/before_ladder.h"
#include "simulator/physics/physics_mechanics.h"

namespace simulator {
namespace {

Scene tall_ladder() {
  SceneParams params;
  params.num_rungs = 10;
  params.rung_diameter_m = 0.028;
  return make_scene(params);
}

class PhysicsModelTest : public ::testing::Test {
 protected:
  Scene scene_ = tall_ladder();
  PhysicsModel model_{scene_};
};

/// The model's feet are where the controller's kinematics put them, for random angles of every leg.
TEST_F(PhysicsModelTest, FeetAgreeWithTheControllersKinematics) {
  const climb::LegKinematics kinematics{climb::RobotParams{}};
  base::Rng rng(5);
  mjData& state = model_.state();
  for (int i = 0; i < 200; ++i) {
    for (int leg = 0; leg < kNumLegs; ++leg) {
      Eigen::Vector3d angles(1.6 * rng.uniform() - 0.8, 3.0 * rng.uniform() - 1.5,
                             forward_sign(leg) * (0.2 + 2.2 * rng.uniform()));
      for (int joint = 0; joint < 3; ++joint) {
        state.qpos[model_.joint(axis_of(leg, joint)).position] = angles[joint];
      }
      mj_kinematics(&model_.model(), &state);
      const Eigen::Map<const Eigen::Vector3d> torso(state.xpos + 3 * model_.torso_body());
      const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> attitude(
          state.xmat + 9 * model_.torso_body());
      const Eigen::Map<const Eigen::Vector3d> foot(state.site_xpos + 3 * model_.foot_site(leg));
      const Eigen::Vector3d foot_in_body = attitude.transpose() * (foot - torso);
      const Eigen::Vector3d believed =
          kinematics.foot_m(climb::kLegs[static_cast<std::size_t>(leg)], angles);
      EXPECT_LT((foot_in_body - believed).norm(), 1e-9) << "leg " << leg;
    }
  }
}

/// The robot weighs what the controller's mass model says.
TEST_F(PhysicsModelTest, MassAgreesWithTheController) {
  const climb::MassParams mass;
  const double believed_kg =
      mass.torso_kg + 4.0 * (mass.abduction_kg + mass.thigh_kg + mass.shank_kg + mass.claw_kg);
  EXPECT_NEAR(mj_getTotalmass(&model_.model()), believed_kg, 0.1);
}

/// Joint limits of the model are those the controller keeps to.
TEST_F(PhysicsModelTest, LimitsAgreeWithTheController) {
  const climb::RobotParams robot;
  const mjModel& model = model_.model();
  for (int leg = 0; leg < kNumLegs; ++leg) {
    const auto range = [&](int joint) {
      for (int id = 0; id < model.njnt; ++id) {
        if (model.jnt_qposadr[id] == model_.joint(axis_of(leg, joint)).position) {
          return Eigen::Vector2d(model.jnt_range[2 * id], model.jnt_range[2 * id + 1]);
        }
      }
      return Eigen::Vector2d(0.0, 0.0);
    };
    EXPECT_EQ(range(0), Eigen::Vector2d(robot.abduction.min_rad, robot.abduction.max_rad));
    EXPECT_EQ(range(1), Eigen::Vector2d(robot.hip.min_rad, robot.hip.max_rad));
    const Eigen::Vector2d bend(robot.knee_bend.min_rad, robot.knee_bend.max_rad);
    EXPECT_EQ(range(2), forward_sign(leg) > 0.0 ? bend : Eigen::Vector2d(-bend.y(), -bend.x()));
  }
}

/// A removed rung is gone for contacts and for rays.
TEST_F(PhysicsModelTest, RemovedRungIsGone) {
  model_.remove_rung(2);
  int num_removed = 0;
  for (int geom = 0; geom < model_.model().ngeom; ++geom) {
    if (model_.rung_of_geom(geom) != 2) continue;
    ++num_removed;
    EXPECT_EQ(model_.model().geom_contype[geom], 0);
    EXPECT_EQ(model_.model().geom_rgba[4 * geom + 3], 0.0F);
  }
  EXPECT_GT(num_removed, 0);
}

/// A scene without a ladder, or without a sound rung where a claw must start, is refused by name.
TEST(BeforeLadder, RefusesWhatCannotBeClimbed) {
  SceneParams params;
  params.kind = SceneKind::kBoxes;
  EXPECT_THROW(before_ladder(make_scene(params)), std::invalid_argument);
  params.kind = SceneKind::kPlain;
  params.num_rungs = 1;
  EXPECT_THROW(before_ladder(make_scene(params)), std::invalid_argument);
}

}  // namespace
}  // namespace simulator
