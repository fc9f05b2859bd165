// SPDX-License-Identifier: BSD-3-Clause
// After the first frames a frame allocates nothing. Own program: it replaces operator new.
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>

#include "ddgng/ddgng.h"
#include "room.h"

namespace {
long num_allocations = 0;
}  // namespace

[[gnu::noinline]] void* operator new(std::size_t size) {
  ++num_allocations;
  void* memory = std::malloc(size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
  ++num_allocations;
  const auto align = static_cast<std::size_t>(alignment);
  void* memory = std::aligned_alloc(align, (size + align - 1) / align * align);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

namespace ddgng {
namespace {

// The counter works, or the test below would prove nothing.
TEST(Allocation, IsCounted) {
  const long before = num_allocations;
  ::operator delete(::operator new(10));  // a vector nobody reads may be optimised away
  EXPECT_GT(num_allocations, before);
}

// From the second frame on, frames of changing clouds (also an empty one) allocate nothing.
TEST(Allocation, NoneAfterWarmUp) {
  const Room ladder = RoomBuilder(1).build(40000);
  const Room no_ladder = RoomBuilder(2).build(30000, false);
  const Room empty;
  DynamicDensityGng gng(DdgngParams{});
  gng.update(ladder.view(0));
  gng.update(ladder.view(1));
  const long before = num_allocations;
  for (int frame = 2; frame < 12; ++frame) {
    gng.update(frame % 5 == 0 ? empty.view(frame)
                              : (frame % 2 == 0 ? ladder : no_ladder).view(frame));
  }
  EXPECT_EQ(num_allocations, before);
}

}  // namespace
}  // namespace ddgng
