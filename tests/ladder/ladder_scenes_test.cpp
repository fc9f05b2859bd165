// SPDX-License-Identifier: BSD-3-Clause
// The default mode on drawn scenes with exact truth: what is found, what is flagged, what is
// offered.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "ladder/ladder.h"
#include "tests/support/ladder_scene.h"

namespace {

using ladder::LadderEstimate;
using ladder::LadderParams;
using ladder::LadderState;
using ladder::LadderTracker;
using ladder::Rung;
using ladder::RungState;
using test_support::LadderScene;
using test_support::LadderShape;
using test_support::RungTruth;

constexpr int kNumFrames = 8;

LadderEstimate run(const LadderScene& scene, int num_frames = kNumFrames) {
  LadderTracker tracker{LadderParams{}};
  LadderEstimate estimate;
  for (int frame = 0; frame < num_frames; ++frame) estimate = tracker.update(scene.cloud(frame));
  return estimate;
}

const Rung* match(const LadderEstimate& estimate, const RungTruth& truth) {
  const Eigen::Vector3d middle = 0.5 * (truth.end0_m + truth.end1_m);
  for (const Rung& rung : estimate.rungs) {
    const double off = (0.5 * (rung.end0_m + rung.end1_m) - middle).norm();
    if (off < 0.05) return &rung;
  }
  return nullptr;
}

int num_trusted(const LadderEstimate& estimate) {
  return static_cast<int>(
      std::count_if(estimate.rungs.begin(), estimate.rungs.end(),
                    [](const Rung& rung) { return rung.state == RungState::kTrusted; }));
}

// Every rung of a plain ladder is trusted, on its axis, between the rails' inner faces.
TEST(LadderScenes, FindsEveryRungOfAPlainLadder) {
  for (const double distance_m : {0.6, 1.0, 1.5}) {
    for (const double yaw_rad : {0.0, 0.26, -0.52}) {
      LadderShape shape;
      shape.distance_m = distance_m;
      shape.yaw_rad = yaw_rad;
      LadderScene scene(7);
      scene.add_ladder(shape);
      scene.add_front(distance_m + 0.9, 1.0, 0.0, 2.5, true);
      const LadderEstimate estimate = run(scene);
      SCOPED_TRACE(testing::Message() << distance_m << " m, yaw " << yaw_rad);
      ASSERT_EQ(estimate.state, LadderState::kConfirmed);
      EXPECT_NEAR(estimate.spacing_m, 0.30, 0.003);
      EXPECT_EQ(num_trusted(estimate), shape.num_rungs);
      for (const RungTruth& truth : scene.truth) {
        const Rung* rung = match(estimate, truth);
        ASSERT_NE(rung, nullptr);
        EXPECT_EQ(rung->flags, 0);
        EXPECT_LT((rung->end0_m - truth.end0_m).norm(), 0.012);
        EXPECT_LT((rung->end1_m - truth.end1_m).norm(), 0.012);
      }
    }
  }
}

// A ladder is confirmed within four frames.
TEST(LadderScenes, ConfirmsWithinFourFrames) {
  LadderScene scene(3);
  scene.add_ladder({});
  EXPECT_EQ(run(scene, 2).state, LadderState::kNone);
  const LadderEstimate estimate = run(scene, 4);
  EXPECT_EQ(estimate.state, LadderState::kConfirmed);
  EXPECT_EQ(num_trusted(estimate), 8);
}

}  // namespace
