// SPDX-License-Identifier: BSD-3-Clause
// Polling allocates nothing while the chip is there. Own program: it counts what operator new is
// asked for.
#include <optional>

#include <gtest/gtest.h>
#include <sys/socket.h>

#include "fake_chip.h"
#include "gpio/lines.h"
#include "gpio/unix_lines.h"
#include "simulator/plant/line_hub.h"
#include "tests/support/allocation_counter.h"

namespace gpio {
namespace {

// The counter works, or the test below would prove nothing.
TEST(GpioAllocation, IsCounted) {
  const std::size_t before = test_support::allocated_bytes();
  FakeChip chip;
  const Lines lines(LinesParams{}, chip);
  EXPECT_GT(test_support::allocated_bytes(), before);
}

// Zero bytes in a thousand polls with every line changing, and in the poll that sees the loss.
TEST(GpioAllocation, NonePerPoll) {
  int ends[2] = {-1, -1};
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK, 0, ends), 0);
  std::optional<simulator::LineHub> hub(std::in_place, "");
  hub->add_client(ends[0]);
  UnixLines chip(ends[1]);
  Lines lines({}, chip);
  std::size_t bytes = 0;
  int num_changes = 0;
  LineStates last;
  const auto poll = [&](int i) {
    const std::size_t before = test_support::allocated_bytes();
    lines.poll(std::int64_t{i} * 10'000);
    bytes += test_support::allocated_bytes() - before;
    num_changes += lines.states() != last;
    last = lines.states();
  };
  for (int i = 0; i < 1000; ++i) {
    const bool high = i / 3 % 2 == 0;
    hub->publish({high, !high, high, !high, high});
    poll(i);
  }
  hub.reset();
  poll(1000);
  EXPECT_TRUE(last.lost);
  EXPECT_EQ(bytes, 0U);
  EXPECT_GT(num_changes, 600);
}

}  // namespace
}  // namespace gpio
