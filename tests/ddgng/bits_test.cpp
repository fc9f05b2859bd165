// SPDX-License-Identifier: BSD-3-Clause
// The whole topology, bit for bit, is what it was on the day this number was written down: with any
// compiler, on any machine. A change of the algorithm's arithmetic changes it, and must say so.
#include "bits.h"

#include <gtest/gtest.h>

namespace ddgng {
namespace {

// Twenty frames of a moving room.
TEST(Bits, AsWrittenDown) {
  EXPECT_EQ(bits_after(100'000), 0x49404f626f592eadULL);
}

}  // namespace
}  // namespace ddgng
