// SPDX-License-Identifier: BSD-3-Clause
// The in-memory bus: order, loss, delay, and queues that stall.
#include <gtest/gtest.h>

#include "bench_master.h"
#include "simulator/plant/memory_bus.h"

namespace simulator {
namespace {

std::vector<std::uint32_t> received(MemoryBus& bus, int port, std::int64_t now_us) {
  std::vector<std::uint32_t> ids;
  for (CarriedFrame carried; bus.receive(port, now_us, carried);) ids.push_back(carried.frame.id);
  return ids;
}

// Nobody hears himself; everybody else hears each frame once, in order, not before its time.
TEST(MemoryBus, DeliversInOrder) {
  MemoryBus bus(1, 100);
  const int a = bus.attach(), b = bus.attach(), c = bus.attach();
  bus.send(a, frame_of(0x181, {}), 0);
  bus.send(b, frame_of(0x182, {}), 0);
  EXPECT_TRUE(received(bus, c, 99).empty());
  EXPECT_EQ(received(bus, c, 100), (std::vector<std::uint32_t>{0x181, 0x182}));
  EXPECT_EQ(received(bus, a, 100), (std::vector<std::uint32_t>{0x182}));
  EXPECT_EQ(received(bus, b, 100), (std::vector<std::uint32_t>{0x181}));
  EXPECT_TRUE(received(bus, c, 1'000'000).empty());
}

// A delayed port's frames arrive later than younger ones of others.
TEST(MemoryBus, DelayReorders) {
  MemoryBus bus;
  const int a = bus.attach(), b = bus.attach(), c = bus.attach();
  bus.faults(a).delay_us = 500;
  bus.send(a, frame_of(0x181, {}), 0);
  bus.send(b, frame_of(0x182, {}), 100);
  EXPECT_EQ(bus.next_due_us(c), 100);
  EXPECT_EQ(received(bus, c, 1000), (std::vector<std::uint32_t>{0x182, 0x181}));
}

// Shares of loss and duplication are kept within chance.
TEST(MemoryBus, LossAndDuplication) {
  MemoryBus bus(5);
  const int a = bus.attach(), b = bus.attach();
  bus.faults(a) = {.loss_share = 0.25, .duplicate_share = 0.5};
  for (int i = 0; i < 10'000; ++i) bus.send(a, frame_of(0x181, {}), i);
  // 0.75 arrive, half of them twice: 1.125; standard deviation below 0.008.
  EXPECT_NEAR(static_cast<double>(received(bus, b, 20'000).size()), 11'250.0, 320.0);
}

// A stalled queue takes so many frames, then refuses; they leave later with their old age, unless
// purged. A bus that is down takes none.
TEST(MemoryBus, StallsAndGoesDown) {
  MemoryBus bus;
  const int a = bus.attach(), b = bus.attach();
  bus.record(true);
  bus.queue_length = 2;
  bus.set_condition(BusCondition::kStalled, 0);
  EXPECT_EQ(bus.send(a, frame_of(0x201, {}), 0), SendResult::kSent);
  EXPECT_EQ(bus.send(a, frame_of(0x202, {}), 0), SendResult::kSent);
  EXPECT_EQ(bus.send(a, frame_of(0x203, {}), 0), SendResult::kNoBuffers);
  EXPECT_EQ(bus.num_waiting(a), 2);
  EXPECT_TRUE(received(bus, b, 1'000'000).empty());
  bus.set_condition(BusCondition::kUp, 50'000);
  EXPECT_EQ(received(bus, b, 50'000).size(), 2U);
  const auto carried = bus.take_carried();
  ASSERT_EQ(carried.size(), 2U);
  EXPECT_EQ(carried[0].time_us - carried[0].handed_over_us, 50'000);
  bus.set_condition(BusCondition::kStalled, 60'000);
  bus.send(a, frame_of(0x204, {}), 60'000);
  bus.purge(a);
  bus.set_condition(BusCondition::kUp, 70'000);
  EXPECT_TRUE(received(bus, b, 80'000).empty());
  bus.set_condition(BusCondition::kDown, 80'000);
  EXPECT_EQ(bus.send(a, frame_of(0x205, {}), 80'000), SendResult::kDown);
}

}  // namespace
}  // namespace simulator
