// SPDX-License-Identifier: BSD-3-Clause
// Parameters: the defaults hold, a violated relation names its field.
#include <gtest/gtest.h>

#include "tests/climb/robot_poses.h"

namespace climb {
namespace {

// The defaults satisfy every relation.
TEST(ClimbParams, DefaultsHold) {
  EXPECT_EQ(check(ClimbParams()), "");
}

// Each of these violations is found and its field is named; NaN violates everything.
TEST(ClimbParams, NamesTheViolatedField) {
  const auto words_after = [](auto&& change) {
    ClimbParams params;
    change(params);
    return check(params);
  };
  const double nan = climb_tests::kNan;
  EXPECT_NE(words_after([&](auto& p) { p.robot.thigh_m = nan; }).find("robot.thigh_m"),
            std::string::npos);
  EXPECT_NE(words_after([](auto& p) { p.robot.knee_sign[2] = 0.5; }).find("knee_sign"),
            std::string::npos);
  EXPECT_NE(words_after([](auto& p) { p.robot.hip.max_rad = -3.0; }).find("robot.hip.max_rad"),
            std::string::npos);
  EXPECT_NE(words_after([](auto& p) { p.robot.knee_bend.min_rad = -0.1; }).find("knee_bend"),
            std::string::npos);
  EXPECT_NE(words_after([](auto& p) {
              p.robot.claw.empty_rad = p.robot.claw.closed_rad;
            }).find("robot.claw.empty_rad"),
            std::string::npos);
  EXPECT_NE(words_after([](auto& p) { p.robot.mass.torso_kg = 0.0; }).find("mass.torso_kg"),
            std::string::npos);
  EXPECT_NE(words_after([](auto& p) { p.motion.approach_m_s = 0.06; }).find("motion.approach_m_s"),
            std::string::npos);
  EXPECT_NE(words_after([&](auto& p) { p.motion.load_s = nan; }).find("load_s"), std::string::npos);
  EXPECT_NE(words_after([](auto& p) { p.support.min_margin = 0.9; }).find("support.min_margin"),
            std::string::npos);
  EXPECT_NE(words_after([](auto& p) { p.odometry.slip_m = 0.0; }).find("odometry.slip_m"),
            std::string::npos);
  EXPECT_NE(words_after([](auto& p) { p.grasp.max_step_m = 0.1; }).find("grasp.max_step_m"),
            std::string::npos);
}

}  // namespace
}  // namespace climb
