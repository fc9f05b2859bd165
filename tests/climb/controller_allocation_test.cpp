// SPDX-License-Identifier: BSD-3-Clause
// A control cycle allocates nothing, from the first one on.
#include <gtest/gtest.h>

#include "climb/controller.h"
#include "tests/climb/ladder_stand.h"
#include "tests/support/allocation_counter.h"

namespace climb {
namespace {

using test_support::num_allocations;

// Boot, arming, four grasps in the dock and 60 s of climbing.
TEST(ControllerAllocation, IsNone) {
  ControllerParams params;
  params.session_id = 1;
  climb_tests::LadderStand stand(params.climb);
  Controller controller(params);
  ControllerOutput output;
  std::size_t num_in_steps = 0;
  for (int i = 0; i < 9000; ++i) {
    if (i == 100) stand.input.command = {Order::kArm, 1, 1};
    if (i == 3000) stand.input.command = {Order::kClimb, 1, 2};
    const std::size_t before = num_allocations();
    controller.step(stand.input, output);
    num_in_steps += num_allocations() - before;
    stand.step(output);
  }
  EXPECT_EQ(output.state, ControllerState::kClimbing);
  EXPECT_EQ(num_in_steps, 0U);
}

}  // namespace
}  // namespace climb
