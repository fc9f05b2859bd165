// SPDX-License-Identifier: BSD-3-Clause
// main() of every hardware test. They take interfaces away and pull lines: they run only where
// scripts/vm says so (LADDER_VM), elsewhere ctest is told "skipped". Inside, what is missing fails.
#include <cstdio>
#include <cstdlib>

#include <gmock/gmock.h>

namespace {

constexpr int kExitSkipped = 77;  // SKIP_RETURN_CODE of hardware_test()

}  // namespace

int main(int argc, char** argv) {
  if (std::getenv("LADDER_VM") == nullptr) {
    std::puts("SKIPPED: needs the devices of scripts/vm");
    return kExitSkipped;
  }
  ::testing::InitGoogleMock(&argc, argv);
  return RUN_ALL_TESTS();
}
