// SPDX-License-Identifier: BSD-3-Clause
// The real controller and the real CAN master on the robot in physics: it hangs, it takes a rung,
// it survives a rung that breaks, all with claws that hold by contact.
#include <gtest/gtest.h>

#include "robot_in_a_box/climb_box.h"
#include "simulator/physics/before_ladder.h"
#include "simulator/physics/physics_mechanics.h"

namespace robot_in_a_box {
namespace {

using climb::ControllerState;

simulator::Scene ladder() {
  simulator::SceneParams params;
  params.num_rungs = 12;
  params.seed = 2;
  params.rung_diameter_m = 0.028;
  return simulator::make_scene(params);
}

class PhysicsClimbTest : public ::testing::Test {
 protected:
  PhysicsClimbTest() : model_(scene_), box_(box_params()) {}

  ClimbBoxParams box_params() {
    ClimbBoxParams params;
    params.plant = simulator::before_ladder(scene_);
    params.seed = 2;
    params.perception.bias_m = 0.001;
    params.mechanics = [this](const simulator::PlantParams& plant) {
      return std::make_unique<simulator::PhysicsMechanics>(plant, model_);
    };
    return params;
  }
  bool reach(ControllerState state, double within_s) {
    for (int i = 0; i < static_cast<int>(100.0 * within_s) && box_.state() != state; ++i) {
      box_.cycle();
    }
    return box_.state() == state;
  }
  void run_s(double duration_s) {
    for (int i = 0; i < static_cast<int>(100.0 * duration_s); ++i) box_.cycle();
  }
  /// Power-up, four claws closed in the dock, dock released.
  bool hang() {
    if (!reach(ControllerState::kDisarmed, 5.0)) return false;
    box_.order(climb::Order::kArm);
    if (!reach(ControllerState::kArming, 1.0) || !reach(ControllerState::kHold, 60.0)) return false;
    box_.plant().set_docked(false);
    run_s(2.0);
    return true;
  }
  int num_held() const {
    int num = 0;
    for (int leg = 0; leg < simulator::kNumLegs; ++leg) num += box_.plant().leg(leg).holds ? 1 : 0;
    return num;
  }
  double height_m() const { return box_.plant().T_world_body().translation().z(); }

  simulator::Scene scene_ = ladder();
  simulator::PhysicsModel model_;
  ClimbBox box_;
};

/// Released from the dock the robot hangs on four claws: it sags by the claws' clearance at most,
/// and what the claws put on the rungs is its weight.
TEST_F(PhysicsClimbTest, HangsOnFourClaws) {
  const double docked_m = height_m();
  ASSERT_TRUE(hang()) << climb::name(box_.report().output.reason);
  EXPECT_EQ(num_held(), simulator::kNumLegs);
  EXPECT_LT(docked_m - height_m(), 0.015);
  double down_N = 0.0;
  for (int leg = 0; leg < simulator::kNumLegs; ++leg) {
    down_N -= box_.plant().leg(leg).force_on_rung_N.z();
  }
  EXPECT_NEAR(down_N, 9.81 * mj_getTotalmass(&model_.model()), 5.0);
}

/// One whole cycle of four limbs takes the body up by one rung, with at least three claws on rungs
/// all the time, no fall and no violated invariant.
TEST_F(PhysicsClimbTest, ClimbsOneRung) {
  ASSERT_TRUE(hang()) << climb::name(box_.report().output.reason);
  const double before_m = height_m();
  box_.order(climb::Order::kClimb);
  int least_held = simulator::kNumLegs;
  for (int i = 0; i < 3200; ++i) {
    box_.cycle();
    least_held = std::min(least_held, num_held());
  }
  EXPECT_EQ(box_.state(), ControllerState::kClimbing) << climb::name(box_.report().output.reason);
  EXPECT_GE(least_held, 3);
  EXPECT_GT(height_m() - before_m, 0.25);
  EXPECT_FALSE(box_.plant().truth().fallen);
  for (const simulator::Violation& violation : box_.monitor().violations()) {
    ADD_FAILURE() << describe(violation);
  }
}

/// A rung that breaks under a rear claw at rest leaves the robot on the ladder, stopped with the
/// loss as its reason.
TEST_F(PhysicsClimbTest, SurvivesABrokenRung) {
  ASSERT_TRUE(hang()) << climb::name(box_.report().output.reason);
  const int rung = box_.plant().leg(0).rung_index;
  ASSERT_GE(rung, 0);
  box_.plant().world().rung(box_.plant().leg(2).rung_index).break_at_us = box_.now_us();
  run_s(3.0);
  EXPECT_FALSE(box_.plant().truth().fallen);
  EXPECT_EQ(box_.state(), ControllerState::kFaultHold);
  EXPECT_GE(num_held(), 2);
}

}  // namespace
}  // namespace robot_in_a_box
