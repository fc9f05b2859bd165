// SPDX-License-Identifier: BSD-3-Clause
// The CiA 402 master on kernel interfaces, against the plant in a process of its own: power-up to
// operational, and what only a kernel can do to a bus. The first run's frames are kept for decoders
// of others (bus_log_test.py).
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "tests/hardware/bus_log.h"
#include "tests/hardware/can_interface.h"
#include "tests/hardware/real_time_master.h"

namespace {

using can::BusPhase;
using can::FaultCause;
using hardware::BareSocket;
using hardware::kernel_frame;
using hardware::master_params;
using hardware::RealTimeMaster;
using support::ChildProcess;

constexpr std::int64_t k100Hz_us = 10'000;
constexpr std::int64_t k50Hz_us = 20'000;

class Plant {
 public:
  explicit Plant(const std::string& interface)
      : process_(LADDER_PLANT_PROGRAM, {"--can", interface, "--print_period_s", "0"}) {}

 private:
  ChildProcess process_;
};

void expect_sine_is_followed(RealTimeMaster& master, int num_cycles) {
  const double start_rad = master.feedback[1].position_rad;
  double worst_rad = 0.0;
  for (int i = 0; i < num_cycles; ++i) {
    master.targets[1].position_rad = start_rad + 0.1 * (1.0 - std::cos(0.02 * i));
    master.cycle();
    worst_rad = std::max(
        worst_rad, std::abs(master.feedback[1].position_rad - master.targets[1].position_rad));
  }
  EXPECT_LT(worst_rad, 0.1);
  EXPECT_GT(worst_rad, 0.0);
}

void report(const char* what, const RealTimeMaster& master) {
  std::printf("%s: %d cycles, %d overruns, worst %.1f ms late\n", what, master.num_cycles,
              master.num_overruns, 1e-3 * static_cast<double>(master.worst_late_us));
}

// Sixteen axes at 100 Hz from power-up: every object written and read back, enabled, moved,
// disabled, and no fault on the way.
TEST(MasterOnKernel, SixteenAxesAt100Hz) {
  hardware::BusLog log("vcan0");
  const Plant plant("vcan0");
  RealTimeMaster master("vcan0", master_params(16, k100Hz_us));
  master.run(1.0);
  ASSERT_TRUE(master.bus().configure());
  ASSERT_TRUE(master.reach(BusPhase::kReady)) << master.problems();
  EXPECT_TRUE(master.bus().capabilities().hold_on_loss);
  ASSERT_TRUE(master.bus().enable());
  ASSERT_TRUE(master.reach(BusPhase::kEnabled)) << master.problems();
  for (const can::AxisFeedback& axis : master.feedback) {
    EXPECT_EQ(axis.state, can::DriveState::kOperationEnabled);
  }
  expect_sine_is_followed(master, 400);
  ASSERT_TRUE(master.bus().disable());
  EXPECT_TRUE(master.reach(BusPhase::kReady)) << master.problems();
  EXPECT_TRUE(master.bus().faults().empty()) << master.problems();
  EXPECT_EQ(master.bus().num_malformed(), 0U);
  report("16 axes at 100 Hz on vcan", master);
  log.keep(LADDER_BUS_LOG);
}

// Four axes at 50 Hz over an emulated pair of controllers with a real driver, 1 Mbit/s.
TEST(MasterOnKernel, FourAxesOverControllerPair) {
  const Plant plant("can1");
  RealTimeMaster master("can0", master_params(4, k50Hz_us));
  master.run(1.0);
  ASSERT_TRUE(master.bus().configure());
  ASSERT_TRUE(master.reach(BusPhase::kReady, 40.0)) << master.problems();
  ASSERT_TRUE(master.bus().enable());
  ASSERT_TRUE(master.reach(BusPhase::kEnabled)) << master.problems();
  expect_sine_is_followed(master, 200);
  ASSERT_TRUE(master.bus().disable());
  EXPECT_TRUE(master.reach(BusPhase::kReady)) << master.problems();
  EXPECT_TRUE(master.bus().faults().empty()) << master.problems();
  report("4 axes at 50 Hz on kvaser_pci", master);
}

/// Four axes, enabled, on an interface that may be harmed.
class HarmedBus : public ::testing::Test {
 protected:
  void SetUp() override {
    master.run(0.5);
    ASSERT_TRUE(master.bus().configure());
    ASSERT_TRUE(master.reach(BusPhase::kReady)) << master.problems();
    ASSERT_TRUE(master.bus().enable());
    ASSERT_TRUE(master.reach(BusPhase::kEnabled)) << master.problems();
  }
  /// Frames that the master sends within a while, heard by another socket.
  static int frames_of_master(BareSocket& ear, int for_ms) {
    int count = 0;
    const std::int64_t end_us = hardware::monotonic_us() + 1000 * for_ms;
    while (hardware::monotonic_us() < end_us) {
      const auto frame = ear.receive(1);
      if (frame && (frame->can_id == 0x080 || (frame->can_id & ~0x7FU) == 0x200)) ++count;
    }
    return count;
  }

  hardware::VirtualCan line{"lt0"};
  Plant plant{"lt0"};
  RealTimeMaster master{"lt0", master_params(4, k100Hz_us)};
};

// Bus-off, as the driver tells it: a fault in the next cycle and not one frame more; clearing it is
// an explicit act, and then the axes come back to life.
TEST_F(HarmedBus, BusOffSilencesTheMaster) {
  BareSocket driver("lt0");
  ASSERT_TRUE(driver.send(kernel_frame(CAN_ERR_FLAG | CAN_ERR_BUSOFF, std::string(8, '\0'))));
  master.run(0.05);
  EXPECT_TRUE(master.has_fault(FaultCause::kBusOff)) << master.problems();
  EXPECT_EQ(master.bus().phase(), BusPhase::kFaulted);
  while (driver.receive(0)) {
  }
  master.run(0.3);
  EXPECT_EQ(frames_of_master(driver, 50), 0);
  ASSERT_TRUE(master.bus().rearm());
  EXPECT_TRUE(master.reach(BusPhase::kReady)) << master.problems();
  ASSERT_TRUE(master.bus().enable());
  EXPECT_TRUE(master.reach(BusPhase::kEnabled)) << master.problems();
}

// Taken down and deleted while running: a fault each time, and the line is found again by its name.
TEST_F(HarmedBus, InterfaceGoesAndComesBack) {
  line.down();
  master.run(0.05);
  EXPECT_TRUE(master.has_fault(FaultCause::kInterfaceLost)) << master.problems();
  line.up();
  master.run(1.0);
  ASSERT_TRUE(master.bus().rearm());
  master.run(0.5);
  EXPECT_NE(master.bus().phase(), BusPhase::kFaulted) << master.problems();
  line.remove();
  master.run(0.05);
  EXPECT_TRUE(master.has_fault(FaultCause::kInterfaceLost)) << master.problems();
}

// Ten odd frames in a second are only counted, more are a fault.
TEST_F(HarmedBus, OddFramesAreCounted) {
  BareSocket stranger("lt0");
  const std::uint64_t before = master.bus().num_malformed();  // the plant has more nodes than four
  canfd_frame fd{};
  fd.can_id = 0x181;
  fd.len = 12;
  for (int i = 0; i < 10; ++i) {
    if (i % 3 == 0) {
      ASSERT_TRUE(stranger.send(fd));
    } else {
      ASSERT_TRUE(stranger.send(kernel_frame(i % 3 == 1 ? 0x181 | CAN_RTR_FLAG : 0x181, "x")));
    }
  }
  master.run(0.1);
  EXPECT_EQ(master.bus().num_malformed(), before + 10);
  EXPECT_FALSE(master.has_fault(FaultCause::kMalformedFrames)) << master.problems();
  ASSERT_TRUE(stranger.send(fd));
  master.run(0.05);
  EXPECT_TRUE(master.has_fault(FaultCause::kMalformedFrames)) << master.problems();
}

// A frame that only a master sends, from another program of this host: a fault.
TEST_F(HarmedBus, SecondMasterIsNoticed) {
  BareSocket second("lt0");
  ASSERT_TRUE(second.send(kernel_frame(0x201, std::string("\x0F\0\0\0\0\0\0\0", 8))));
  master.run(0.05);
  EXPECT_TRUE(master.has_fault(FaultCause::kForeignMaster)) << master.problems();
}

}  // namespace
