// SPDX-License-Identifier: BSD-3-Clause
// A control cycle allocates nothing, from the first one on. A program of its own: it replaces
// operator new.
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>

#include "climb/controller.h"
#include "tests/climb/ladder_stand.h"

namespace {
long num_allocations = 0;
}  // namespace

// Not inlined: the compiler would see free() meet a pointer of operator new and warn.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++num_allocations;
  if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace climb {
namespace {

// Boot, arming, four grasps in the dock and 60 s of climbing.
TEST(ControllerAllocation, IsNone) {
  ControllerParams params;
  params.session_id = 1;
  climb_tests::LadderStand stand(params.climb);
  Controller controller(params);
  ControllerOutput output;
  long num_in_steps = 0;
  for (int i = 0; i < 9000; ++i) {
    if (i == 100) stand.input.command = {Order::kArm, 1, 1};
    if (i == 3000) stand.input.command = {Order::kClimb, 1, 2};
    const long before = num_allocations;
    controller.step(stand.input, output);
    num_in_steps += num_allocations - before;
    stand.step(output);
  }
  EXPECT_EQ(output.state, ControllerState::kClimbing);
  EXPECT_EQ(num_in_steps, 0);
}

}  // namespace
}  // namespace climb
