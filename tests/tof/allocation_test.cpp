// SPDX-License-Identifier: BSD-3-Clause
// After the first frames of each head nothing is taken from the heap any more.
#include <gtest/gtest.h>

#include "tests/support/allocation_counter.h"
#include "tests/tof/frame_builder.h"
#include "tof/fusion.h"

namespace {

using test_support::num_allocations;

// Two rounds warm up; then a hundred, with more and fewer points, take nothing.
TEST(FusionMemory, NoAllocationPerFrame) {
  tof::TofParams params;
  params.max_points = 20000;
  tof::Fusion fusion(params);
  tof_test::FrameBuilder full(224, 171, 1000);
  tof_test::FrameBuilder empty(224, 171, 0);
  full.frame.depth_kind = empty.frame.depth_kind = tof::DepthKind::kRadial;
  std::size_t before = 0;
  std::int64_t num_clouds = 0;
  for (int round = 0; round < 102; ++round) {
    if (round == 2) before = num_allocations();
    for (int head = 0; head < tof::kNumHeads; ++head) {
      const auto utime_us = tof_test::kStart_us + tof_test::kPeriod_us * round + 16'000 * head;
      fusion.add_imu({utime_us, {0.0, 0.1, 9.8}, {0.0, 0.0, 0.0}});
      auto& builder = round % 3 == 1 ? empty : full;
      num_clouds += fusion.add_frame(builder.view(head, utime_us, round)).clouds.size();
    }
  }
  EXPECT_GT(num_clouds, 100);
  EXPECT_GT(before, 0U) << "the counter counts";
  EXPECT_EQ(num_allocations(), before);
}

}  // namespace
