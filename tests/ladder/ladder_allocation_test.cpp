// SPDX-License-Identifier: BSD-3-Clause
// No heap allocation per frame once constructed and warmed up.
#include <gtest/gtest.h>

#include "ladder/ladder.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/ladder_scene.h"

namespace {

using ladder::LadderParams;
using ladder::LadderTracker;
using test_support::LadderScene;
using test_support::num_allocations;

std::size_t allocations_while_running(const LadderParams& params) {
  LadderScene ladder_scene(2), stairs(2), shelf(2);
  ladder_scene.add_ladder({});
  ladder_scene.add_board({0.98, 0.05, 0.85}, {0.98, -0.05, 0.85}, 0.06);
  stairs.add_stairs(0.8, 6);
  shelf.add_shelf(0.9);
  std::vector<ladder::NodeCloud> clouds;
  for (int frame = 0; frame < 8; ++frame) {
    clouds.push_back(ladder_scene.cloud(4 * frame));
    clouds.push_back(stairs.cloud(4 * frame + 1));
    clouds.push_back(shelf.cloud(4 * frame + 2));
    clouds.push_back(ladder_scene.cloud(4 * frame + 3));
  }
  LadderTracker tracker(params);
  tracker.update(clouds[0]);
  const std::size_t before = num_allocations();
  for (const auto& cloud : clouds) tracker.update(cloud);
  tracker.reset();
  for (int frame = 0; frame < 30; ++frame) {
    auto& cloud = clouds[frame % 2 == 0 ? 0 : 3];
    cloud.sequence = 100 + frame;
    tracker.update(cloud);
  }
  return num_allocations() - before;
}

// The default mode allocates nothing per frame.
TEST(Allocation, DefaultModeAllocatesNothing) {
  EXPECT_EQ(allocations_while_running(LadderParams{}), 0U);
}

// Nor does the paper's.
TEST(Allocation, PaperModeAllocatesNothing) {
  LadderParams params = ladder::paper_params();
  params.paper.inlier_m = 0.02;
  params.paper.outlier_m = 0.04;
  params.paper.tries = 500;
  EXPECT_EQ(allocations_while_running(params), 0U);
}

}  // namespace
