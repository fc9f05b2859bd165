// SPDX-License-Identifier: BSD-3-Clause
// What must not matter: where the odometry frame lies, what was seen before a reset, which of two
// equal trackers is asked.
#include <cmath>
#include <cstring>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "ladder/ladder.h"
#include "tests/support/ladder_scene.h"

namespace {

using ladder::LadderEstimate;
using ladder::LadderParams;
using ladder::LadderTracker;
using test_support::LadderScene;
using test_support::LadderShape;

class Invariance : public testing::TestWithParam<ladder::Mode> {
 protected:
  LadderParams params() const {
    LadderParams params;
    params.mode = GetParam();
    params.paper.inlier_m = 0.02;
    params.paper.outlier_m = 0.04;
    params.paper.tries = 300;
    params.paper.inlier_ratio = 1.0;
    params.paper.xi = 0.2;
    params.paper.xi_age = 0.05;
    return params;
  }
  LadderScene scene() const {
    LadderScene scene(11);
    LadderShape shape;
    shape.yaw_rad = 0.2;
    shape.stub_rung = 2;
    shape.num_rungs = 6;
    scene.add_ladder(shape);
    scene.node_spacing_m = 0.015;
    return scene;
  }
};

INSTANTIATE_TEST_SUITE_P(BothModes, Invariance,
                         testing::Values(ladder::Mode::kDefault, ladder::Mode::kPaper));

void expect_same_bits(const LadderEstimate& a, const LadderEstimate& b) {
  ASSERT_EQ(a.rungs.size(), b.rungs.size());
  ASSERT_EQ(a.intervals.size(), b.intervals.size());
  EXPECT_EQ(a.state, b.state);
  EXPECT_EQ(a.spacing_m, b.spacing_m);
  for (std::size_t i = 0; i < a.rungs.size(); ++i) {
    EXPECT_EQ(a.rungs[i].id, b.rungs[i].id);
    EXPECT_EQ(a.rungs[i].end0_m, b.rungs[i].end0_m);
    EXPECT_EQ(a.rungs[i].end1_m, b.rungs[i].end1_m);
    EXPECT_EQ(a.rungs[i].covariance_m2, b.rungs[i].covariance_m2);
  }
}

// Two trackers fed alike give the same bits.
TEST_P(Invariance, EqualInputGivesEqualBits) {
  LadderTracker first(params()), second(params());
  for (int frame = 0; frame < 6; ++frame) {
    const auto cloud = scene().cloud(frame);
    expect_same_bits(first.update(cloud), second.update(cloud));
  }
}

// After reset() a tracker is as good as new.
TEST_P(Invariance, ResetForgetsEverything) {
  LadderTracker used(params()), fresh(params());
  for (int frame = 20; frame < 30; ++frame) used.update(scene().cloud(frame));
  used.reset();
  for (int frame = 0; frame < 6; ++frame) {
    const auto cloud = scene().cloud(frame);
    expect_same_bits(used.update(cloud), fresh.update(cloud));
  }
}

// Turning and moving the world turns and moves the result, and nothing else. (The paper's boxes are
// axis-aligned: they are made to hold everything, so that the same nodes are eligible.)
TEST_P(Invariance, FollowsRigidMotion) {
  for (const double yaw_rad : {0.7, 2.5, -1.9}) {
    const Eigen::Vector3d by_m(3.0, -2.0, 0.4);
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    LadderTracker here(params()), there(params());
    LadderEstimate a, b;
    for (int frame = 0; frame < 8; ++frame) {
      auto cloud = scene().cloud(frame);
      cloud.suspected[0] = {{0.0F, 0.0F, 0.0F}, {100.0F, 100.0F, 100.0F}};
      a = here.update(cloud);
      b = there.update(test_support::moved(cloud, yaw_rad, by_m));
    }
    ASSERT_EQ(a.rungs.size(), b.rungs.size());
    ASSERT_GT(a.rungs.size(), 2U);
    EXPECT_EQ(a.state, b.state);
    EXPECT_NEAR(a.spacing_m, b.spacing_m, 1e-4);
    EXPECT_EQ(a.grasps.size(), b.grasps.size());
    for (std::size_t i = 0; i < a.rungs.size(); ++i) {
      EXPECT_EQ(a.rungs[i].flags, b.rungs[i].flags);
      EXPECT_EQ(a.rungs[i].state, b.rungs[i].state);
      EXPECT_LT((turn * a.rungs[i].end0_m + by_m - b.rungs[i].end0_m).norm(), 1e-4);
      EXPECT_LT((turn * a.rungs[i].end1_m + by_m - b.rungs[i].end1_m).norm(), 1e-4);
    }
  }
}

}  // namespace
