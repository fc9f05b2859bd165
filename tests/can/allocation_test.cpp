// SPDX-License-Identifier: BSD-3-Clause
// A cycle of sixteen axes allocates nothing, in good times and while faults come in. Own program:
// it counts what operator new is asked for.
#include <gtest/gtest.h>

#include "bus_rig.h"
#include "tests/support/allocation_counter.h"

namespace can {
namespace {

constexpr int kNumAxes = 16;

/// Cycles with answers prepared beforehand, since the scripted drives allocate.
std::size_t bytes_of_cycles(BusRig& rig, const std::vector<std::vector<CanFrame>>& answers) {
  const std::size_t before = test_support::allocated_bytes();
  for (const std::vector<CanFrame>& frames : answers) {
    rig.time_us += 10'000;
    for (const CanFrame& frame : frames) rig.line.put(frame);
    rig.bus->exchange(rig.time_us, {rig.time_us, rig.targets}, rig.feedback);
  }
  return test_support::allocated_bytes() - before;
}

// The counter works, or the test below would prove nothing.
TEST(CanAllocation, IsCounted) {
  static std::vector<int> kept;  // static: a compiler may leave out an allocation nobody sees
  const std::size_t before = test_support::allocated_bytes();
  kept.resize(10);
  EXPECT_GT(test_support::allocated_bytes(), before + kept.size());
}

// Zero bytes in a thousand cycles while enabled, and in cycles full of faults of every kind.
TEST(CanAllocation, NonePerExchange) {
  BusRig rig(kNumAxes);
  ASSERT_TRUE(rig.bring_to_enabled());
  rig.cycle();
  std::vector<std::vector<CanFrame>> good(1000);
  for (std::size_t i = 0; i < good.size(); ++i) {
    for (int node = 1; node <= kNumAxes; ++node) {
      const auto offset = static_cast<std::uint32_t>(node);
      CanFrame state = from_hex("180#2706E803000064");
      state.id += offset;
      state.dlc = 8;
      good[i].push_back(state);
      CanFrame heartbeat = from_hex("700#05");
      heartbeat.id += offset;
      if (i % 10 == 0) good[i].push_back(heartbeat);
    }
  }
  EXPECT_EQ(bytes_of_cycles(rig, good), 0U);
  EXPECT_EQ(rig.bus->phase(), BusPhase::kEnabled);
  EXPECT_TRUE(rig.bus->faults().empty()) << rig.fault_names();

  std::vector<std::vector<CanFrame>> bad(100);
  for (std::size_t i = 0; i < bad.size(); ++i) {
    bad[i] = {from_hex("081#1186210000000000"), from_hex("702#00"), from_hex("703#7F"),
              from_hex("184#0802000000000000"), from_hex("181#00"), from_hex("000#0101")};
  }
  EXPECT_EQ(bytes_of_cycles(rig, bad), 0U);
  EXPECT_GT(rig.bus->faults().size(), 5U);
}

}  // namespace
}  // namespace can
