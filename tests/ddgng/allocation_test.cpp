// SPDX-License-Identifier: BSD-3-Clause
// After the first frames a frame allocates nothing.
#include <gtest/gtest.h>

#include "ddgng/ddgng.h"
#include "room.h"
#include "tests/support/allocation_counter.h"

namespace ddgng {
namespace {

using test_support::num_allocations;

// The counter works, or the test below would prove nothing.
TEST(Allocation, IsCounted) {
  const std::size_t before = num_allocations();
  ::operator delete(::operator new(10));  // a vector nobody reads may be optimised away
  EXPECT_GT(num_allocations(), before);
}

// From the second frame on, frames of changing clouds (also an empty one) allocate nothing.
TEST(Allocation, NoneAfterWarmUp) {
  const Room ladder = RoomBuilder(1).build(40000);
  const Room no_ladder = RoomBuilder(2).build(30000, false);
  const Room empty;
  DynamicDensityGng gng(DdgngParams{});
  gng.update(ladder.view(0));
  gng.update(ladder.view(1));
  const std::size_t before = num_allocations();
  for (int frame = 2; frame < 12; ++frame) {
    gng.update(frame % 5 == 0 ? empty.view(frame)
                              : (frame % 2 == 0 ? ladder : no_ladder).view(frame));
  }
  EXPECT_EQ(num_allocations(), before);
}

}  // namespace
}  // namespace ddgng
