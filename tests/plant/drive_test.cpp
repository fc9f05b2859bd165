// SPDX-License-Identifier: BSD-3-Clause
// One drive alone, frame by frame: what it refuses, how it walks through its states, and what it
// does when its master is gone.
#include <cmath>

#include <gtest/gtest.h>

#include "bench_master.h"

namespace simulator {
namespace {

constexpr int kAbort = 0x80;

// An object that no drive has is refused as missing, an unknown part of one as a missing subindex.
TEST(DriveSdo, UnknownObjectIsAborted) {
  DriveBench bench;
  EXPECT_EQ(bench.read(0x2345)->command, kAbort);
  EXPECT_EQ(bench.read(0x2345)->number, 0x06020000U);
  EXPECT_EQ(bench.read(0x607D, 3)->number, 0x06090011U);
  EXPECT_EQ(bench.write(0x2345, 0, 1, 4)->number, 0x06020000U);
}

// Read-only, wrongly sized and out-of-range writes are refused with their own reasons and change
// nothing.
TEST(DriveSdo, BadWritesAreAborted) {
  DriveBench bench;
  EXPECT_EQ(bench.write(0x6041, 0, 1, 2)->number, 0x06010002U);
  EXPECT_EQ(bench.write(0x605A, 0, 6, 4)->number, 0x06070012U);
  EXPECT_EQ(bench.write(0x6085, 0, 6, 2)->number, 0x06070013U);
  EXPECT_EQ(bench.write(0x6007, 0, 9, 2)->number, 0x06090030U);
  EXPECT_EQ(bench.read(0x605A)->number, 2U);
  EXPECT_EQ(bench.read(0x6007)->number, 1U);
}

// Segmented and block transfers are refused; a request of the wrong length is no request at all.
TEST(DriveSdo, SegmentedRequestIsRefused) {
  DriveBench bench;
  EXPECT_EQ(bench.ask(frame_of(0x601, {0x21, 0x85, 0x60, 0, 8, 0, 0, 0}))->number, 0x06010000U);
  EXPECT_EQ(bench.ask(frame_of(0x601, {0x60, 0, 0, 0, 0, 0, 0, 0}))->number, 0x05040001U);
  EXPECT_EQ(bench.ask(frame_of(0x601, {0xA0, 0x85, 0x60, 0, 0, 0, 0, 0}))->number, 0x05040001U);
  EXPECT_FALSE(bench.ask(frame_of(0x601, {0x40, 0x41, 0x60, 0})));
  EXPECT_FALSE(bench.ask(frame_of(0x601, {0x80, 0x41, 0x60, 0, 0, 0, 0, 0})));
}

// What is written by SDO is read back, whole bytes on the wire.
TEST(DriveSdo, ReadBackAsHex) {
  DriveBench bench;
  bench.sent.clear();
  bench.send(frame_of(0x601, {0x23, 0x16, 0x10, 0x01, 0x96, 0x00, 0x7F, 0x00}));
  bench.send(frame_of(0x601, {0x40, 0x16, 0x10, 0x01, 0, 0, 0, 0}));
  bench.send(frame_of(0x601, {0x40, 0x00, 0x10, 0x00, 0, 0, 0, 0}));
  ASSERT_EQ(bench.sent.size(), 3U);
  EXPECT_EQ(bench.sent[0], frame_of(0x581, {0x60, 0x16, 0x10, 0x01, 0, 0, 0, 0}));
  EXPECT_EQ(bench.sent[1], frame_of(0x581, {0x43, 0x16, 0x10, 0x01, 0x96, 0x00, 0x7F, 0x00}));
  EXPECT_EQ(bench.sent[2], frame_of(0x581, {0x43, 0x00, 0x10, 0x00, 0x92, 0x01, 0x02, 0x00}));
}

// A drive without 6007h, 6072h and 6077h says so and its PDOs are the six-byte variants.
TEST(DriveSdo, LeftOutObjectsDoNotExist) {
  DriveParams params;
  params.objects = {.abort_connection_option = false, .max_torque = false, .torque_actual = false};
  DriveBench bench(params);
  for (const int index : {0x6007, 0x6072, 0x6077}) {
    EXPECT_EQ(bench.read(index)->number, 0x06020000U);
  }
  EXPECT_EQ(bench.read(0x1600)->number, 2U);
  EXPECT_EQ(bench.read(0x1A00)->number, 2U);
}

// PDO mapping follows the standard's order, and each shortcut is refused.
TEST(DrivePdo, MappingRules) {
  DriveBench bench;
  EXPECT_EQ(bench.write(0x1600, 0, 0, 1)->number, 0x08000022U);  // still valid
  EXPECT_EQ(bench.write(0x1400, 1, 0x80000201, 4)->command, 0x60);
  EXPECT_EQ(bench.write(0x1600, 1, 0x60400010, 4)->number, 0x06010000U);  // count not cleared
  EXPECT_EQ(bench.write(0x1600, 0, 0, 1)->command, 0x60);
  EXPECT_EQ(bench.write(0x1600, 1, 0x60400008, 4)->number, 0x06040041U);  // wrong size
  EXPECT_EQ(bench.write(0x1600, 1, 0x23450010, 4)->number, 0x06020000U);
  EXPECT_EQ(bench.write(0x1600, 1, 0x60400010, 4)->command, 0x60);
  EXPECT_EQ(bench.write(0x1600, 2, 0x607A0020, 4)->command, 0x60);
  EXPECT_EQ(bench.write(0x1600, 3, 0x60B10020, 4)->command, 0x60);
  EXPECT_EQ(bench.write(0x1600, 0, 3, 1)->number, 0x06040042U);  // ten bytes
  EXPECT_EQ(bench.write(0x1600, 0, 2, 1)->command, 0x60);
  EXPECT_EQ(bench.write(0x1400, 1, 0x201, 4)->command, 0x60);
}

// After power-on: one boot-up frame, pre-operational, no heartbeat until 1017h is set.
TEST(DriveNmt, BootsOnce) {
  DriveBench bench;
  bench.advance(500'000);
  ASSERT_EQ(bench.sent.size(), 1U);
  EXPECT_EQ(bench.sent[0], frame_of(0x701, {0x00}));
  EXPECT_EQ(bench.drive.nmt_state(), NmtState::kPreOperational);
}

// Frames of the wrong length change nothing; a short target is reported as 8210h.
TEST(DriveNmt, WrongLengthIsIgnored) {
  DriveBench bench;
  bench.send(frame_of(0x000, {0x01}));
  bench.send(frame_of(0x000, {0x01, 0x01, 0x00}));
  EXPECT_EQ(bench.drive.nmt_state(), NmtState::kPreOperational);
  bench.enable();
  ASSERT_EQ(bench.drive.power_state(), PowerState::kOperationEnabled);
  bench.send(frame_of(0x201, {0x00, 0x00, 0x10, 0x27, 0x00, 0x00}));
  bench.sync();
  bench.advance(10'000);
  EXPECT_EQ(bench.num_emergencies(0x8210), 1);
  EXPECT_EQ(bench.drive.power_state(), PowerState::kOperationEnabled);
  EXPECT_EQ(bench.drive.measured_rad(), 0.0);
}

// The walk of CiA 402: 06 07 0F, one state per SYNC, with the status words of the standard.
TEST(DrivePower, WalksUp) {
  DriveBench bench;
  bench.write(0x6060, 0, 8, 1);
  bench.nmt(0x01);
  const int words[] = {0x06, 0x07, 0x0F, 0x0F};
  const unsigned states[] = {0x40, 0x21, 0x23, 0x27};
  for (int i = 0; i < 4; ++i) {
    bench.sent.clear();
    bench.cycle(words[i], 0.0);
    ASSERT_FALSE(bench.sent.empty());
    EXPECT_EQ(bench.sent[0].id, 0x181U);
    EXPECT_EQ(number_at(bench.sent[0], 0, 2) & 0x6FU, states[i]);
  }
}

// Torque is never given by skipping states: 0F from switch-on-disabled does nothing.
TEST(DrivePower, NoShortcut) {
  DriveBench bench;
  bench.nmt(0x01);
  for (int i = 0; i < 5; ++i) bench.cycle(0x0F, 0.0);
  EXPECT_EQ(bench.drive.power_state(), PowerState::kSwitchOnDisabled);
}

// A fault is left only by a rising edge of bit 7: a bit that stays set does not reset again.
TEST(DrivePower, FaultResetNeedsAnEdge) {
  DriveBench bench;
  bench.enable();
  bench.cycle(0x8F, 0.0);  // bit 7 already high when the fault comes
  bench.drive.raise_fault(0x4310, bench.sent);
  for (int i = 0; i < 20; ++i) bench.cycle(0x8F, 0.0);
  EXPECT_EQ(bench.drive.power_state(), PowerState::kFault);
  bench.cycle(0x00, 0.0);
  EXPECT_EQ(bench.drive.power_state(), PowerState::kFault);
  bench.cycle(0x80, 0.0);
  EXPECT_EQ(bench.drive.power_state(), PowerState::kSwitchOnDisabled);
  EXPECT_EQ(bench.num_emergencies(0x4310), 1);
  EXPECT_EQ(bench.num_emergencies(0x0000), 1);
}

/// Moves at full speed, then takes the master away; when the stop began and ended after the last
/// heartbeat.
struct LossTimes {
  std::int64_t begun_us = -1;
  std::int64_t standing_us = -1;
};
LossTimes lose_master(DriveBench& bench) {
  bench.enable();
  double target = 0.0;
  for (int i = 0; i < 31; ++i) bench.cycle(0x0F, target += 0.025);
  EXPECT_GT(bench.drive.motor().velocity_rad_s(), 2.0);
  bench.master_alive = false;
  bench.heartbeat();
  const std::int64_t last_us = bench.now_us;
  LossTimes times;
  while (bench.now_us - last_us < 500'000 && times.standing_us < 0) {
    if ((bench.now_us - last_us) % 10'000 == 0) {
      bench.command(0x0F, target += 0.025);
      bench.sync();
    }
    bench.advance(1000);
    if (bench.drive.power_state() == PowerState::kOperationEnabled) continue;
    if (times.begun_us < 0) times.begun_us = bench.now_us - last_us;
    if (bench.drive.motor().velocity_rad_s() == 0.0) times.standing_us = bench.now_us - last_us;
  }
  return times;
}

// With 6007h = 3 the quick stop begins 150 ms after the last heartbeat plus at most a tick, the
// joint stands within 300 ms, and stays held in quick stop active though targets go on.
TEST(DriveLoss, QuickStopAndHold) {
  DriveBench bench;
  const LossTimes times = lose_master(bench);
  EXPECT_GE(times.begun_us, 150'000);
  EXPECT_LE(times.begun_us, 151'000);
  EXPECT_LE(times.standing_us, 300'000);
  EXPECT_EQ(bench.num_emergencies(0x8130), 1);
  const double where_rad = bench.drive.measured_rad();
  bench.advance(1'000'000);
  EXPECT_EQ(bench.drive.power_state(), PowerState::kQuickStopActive);
  EXPECT_EQ(bench.drive.measured_rad(), where_rad);
  // The hazard that the controller must know: back again and still saying 0x0F, it is enabled.
  bench.master_alive = true;
  bench.num_cycles = 0;
  bench.cycle(0x0F, where_rad);
  EXPECT_EQ(bench.drive.power_state(), PowerState::kOperationEnabled);
}

// A drive without 6007h does not stop: the reason to refuse it on a ladder.
TEST(DriveLoss, WithoutOptionItGoesOn) {
  DriveParams params;
  params.objects.abort_connection_option = false;
  DriveBench bench(params);
  EXPECT_EQ(lose_master(bench).begun_us, -1);
}

// A heartbeat that never came is not missed (CiA 301): watching begins with the first.
TEST(DriveLoss, NeverHeardIsNotLost) {
  DriveBench bench;
  bench.master_alive = false;
  bench.enable();
  bench.advance(1'000'000);
  EXPECT_EQ(bench.drive.power_state(), PowerState::kOperationEnabled);
}

// A joint that cannot follow is switched off by its own drive with 8611h, after the window's time.
TEST(DriveFollowing, StuckJointFaults) {
  DriveBench bench;
  bench.write(0x6065, 0, 1043, 4);
  bench.write(0x6066, 0, 50, 2);
  bench.enable();
  bench.drive.motor().stuck = true;
  double target = 0.0;
  int cycles = 0;
  while (bench.num_emergencies(0x8611) == 0 && cycles < 100) {
    bench.cycle(0x0F, target += 0.01);
    ++cycles;
  }
  // 0.1 rad are passed after 10 cycles and one of interpolation, the window lasts 5 more.
  EXPECT_NEAR(cycles, 16, 2);
  EXPECT_EQ(bench.drive.power_state(), PowerState::kFault);
  EXPECT_EQ(bench.drive.error_code(), 0x8611);
}

// A reset in mid-motion ends torque at once, comes back by a boot-up frame with factory settings.
TEST(DriveNmt, RebootInMotionForgets) {
  DriveBench bench;
  bench.enable();
  double target = 0.0;
  for (int i = 0; i < 10; ++i) bench.cycle(0x0F, target += 0.02);
  bench.sent.clear();
  bench.drive.reboot(bench.now_us);
  const double where_rad = bench.drive.measured_rad();
  for (int i = 0; i < 10; ++i) bench.cycle(0x0F, target += 0.02);
  ASSERT_FALSE(bench.sent.empty());
  EXPECT_EQ(bench.sent[0], frame_of(0x701, {0x00}));
  EXPECT_EQ(bench.sent.size(), 1U);
  EXPECT_EQ(bench.drive.measured_rad(), where_rad);  // the brake
  EXPECT_EQ(bench.drive.power_state(), PowerState::kSwitchOnDisabled);
  EXPECT_EQ(bench.read(0x1016, 1)->number, 0U);
}

// Targets beyond the soft limits stop at the limit and raise the limit bit.
TEST(DriveLimits, SoftLimitHolds) {
  DriveBench bench;
  bench.write(0x607D, 1, static_cast<std::uint32_t>(-2086), 4);
  bench.write(0x607D, 2, 2086, 4);
  bench.enable();
  for (int i = 0; i < 100; ++i) bench.cycle(0x0F, 0.02 * i);
  EXPECT_NEAR(bench.drive.measured_rad(), 0.2, 1e-3);
  EXPECT_NE(bench.read(0x6041)->number & 0x800U, 0U);
}

// More load than the torque limit allows: the joint yields, and reports the limit as its torque.
TEST(DriveLimits, TorqueSaturates) {
  DriveBench bench;
  bench.enable();
  bench.drive.motor().set_load(25.0);
  for (int i = 0; i < 20; ++i) {
    bench.command(0x0F, 0.0, 1000);  // 20 Nm
    bench.sync();
    bench.heartbeat();
    bench.advance(10'000);
  }
  EXPECT_LT(bench.drive.measured_rad(), -0.05);
  EXPECT_EQ(bench.read(0x6077)->number, 1000U);
}

// The lag is of first order: a small step is answered to 63 % after lag_s (and one interpolation).
TEST(DriveMotion, FirstOrderLag) {
  DriveParams params;
  params.motor.lag_s = 0.050;
  DriveBench bench(params);
  bench.enable();
  bench.write(0x60C2, 1, 0, 1);  // no interpolation
  for (int i = 0; i < 5; ++i) bench.cycle(0x0F, 0.01);
  EXPECT_NEAR(bench.drive.measured_rad(), 0.01 * (1.0 - std::exp(-1.0)), 3e-4);
}

}  // namespace
}  // namespace simulator
