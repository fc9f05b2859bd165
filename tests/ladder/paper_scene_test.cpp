// SPDX-License-Identifier: BSD-3-Clause
// The paper mode, with its literal constants, on the kind of nodes they were made for: a near
// ladder and little noise.
#include <algorithm>

#include <gtest/gtest.h>

#include "ladder/ladder.h"
#include "tests/support/ladder_scene.h"

namespace {

using ladder::RungState;

/// A near ladder on little noise, as the constants want it; every node an obstacle.
ladder::NodeCloud near_ladder(int num_rungs) {
  test_support::LadderScene scene(3);
  scene.noise_sigma_m = 0.001;
  scene.node_spacing_m = 0.015;
  test_support::LadderShape shape;
  shape.rung_diameter_m = 0.012;
  shape.num_rungs = num_rungs;
  shape.distance_m = 0.5;
  scene.add_ladder(shape);
  ladder::NodeCloud cloud = scene.cloud(0);
  for (auto& node_class : cloud.node_class) node_class = ladder::NodeClass::kObstacle;
  return cloud;
}

bool has_trusted(const ladder::LadderEstimate& estimate) {
  return std::any_of(estimate.rungs.begin(), estimate.rungs.end(),
                     [](const auto& rung) { return rung.state == RungState::kTrusted; });
}

// Rungs are trusted after 31 good frames and offered after 111, as the ages say.
TEST(PaperScene, TrustsAndOffersRungsByAge) {
  ladder::LadderTracker tracker(ladder::paper_params());
  ladder::NodeCloud cloud = near_ladder(3);
  int first_trusted = -1;
  int first_offered = -1;
  for (int frame = 0; frame < 160; ++frame) {
    cloud.sequence = frame;
    const ladder::LadderEstimate& estimate = tracker.update(cloud);
    if (has_trusted(estimate) && first_trusted < 0) first_trusted = frame;
    if (!estimate.grasps.empty() && first_offered < 0) first_offered = frame;
  }
  EXPECT_GE(first_trusted, 31);
  EXPECT_LT(first_trusted, 60);
  EXPECT_EQ(first_offered - first_trusted, 80);
}

// A ladder is told only with its spacing, whatever number of rungs is trusted: nobody takes the
// message otherwise.
TEST(PaperScene, TellsNoLadderWithoutASpacing) {
  for (const int num_rungs : {1, 2, 3}) {
    ladder::LadderTracker tracker(ladder::paper_params());
    ladder::NodeCloud cloud = near_ladder(num_rungs);
    bool is_trusted = false;
    bool is_confirmed = false;
    for (int frame = 0; frame < 80; ++frame) {
      cloud.sequence = frame;
      const ladder::LadderEstimate& estimate = tracker.update(cloud);
      is_trusted = has_trusted(estimate);
      is_confirmed = estimate.state == ladder::LadderState::kConfirmed;
      ASSERT_EQ(is_confirmed, estimate.spacing_m > 0.0) << num_rungs << " rungs, frame " << frame;
    }
    EXPECT_TRUE(is_trusted) << num_rungs;
    EXPECT_EQ(is_confirmed, num_rungs == 3);
  }
}

}  // namespace
