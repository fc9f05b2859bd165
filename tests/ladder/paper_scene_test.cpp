// SPDX-License-Identifier: BSD-3-Clause
// The paper mode, with its literal constants, on the kind of nodes they were made for: a near
// ladder and little noise.
#include <algorithm>

#include <gtest/gtest.h>

#include "ladder/ladder.h"
#include "tests/support/ladder_scene.h"

namespace {

using ladder::RungState;

// Rungs are trusted after 31 good frames and offered after 111, as the ages say.
TEST(PaperScene, TrustsAndOffersRungsByAge) {
  test_support::LadderScene scene(3);
  scene.noise_sigma_m = 0.001;
  scene.node_spacing_m = 0.015;
  test_support::LadderShape shape;
  shape.rung_diameter_m = 0.012;
  shape.num_rungs = 3;
  shape.distance_m = 0.5;
  scene.add_ladder(shape);
  ladder::LadderTracker tracker(ladder::paper_params());
  ladder::NodeCloud cloud = scene.cloud(0);
  for (auto& node_class : cloud.node_class) node_class = ladder::NodeClass::kObstacle;
  int first_trusted = -1;
  int first_offered = -1;
  for (int frame = 0; frame < 160; ++frame) {
    cloud.sequence = frame;
    const ladder::LadderEstimate& estimate = tracker.update(cloud);
    const bool is_trusted =
        std::any_of(estimate.rungs.begin(), estimate.rungs.end(),
                    [](const auto& rung) { return rung.state == RungState::kTrusted; });
    if (is_trusted && first_trusted < 0) first_trusted = frame;
    if (!estimate.grasps.empty() && first_offered < 0) first_offered = frame;
  }
  EXPECT_GE(first_trusted, 31);
  EXPECT_LT(first_trusted, 60);
  EXPECT_EQ(first_offered - first_trusted, 80);
}

}  // namespace
