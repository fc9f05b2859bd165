// SPDX-License-Identifier: BSD-3-Clause
// The CiA 402 bus against scripted drives in virtual time: bring-up, walking, stopping, re-arming.
#include "can/cia402_bus.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "bus_rig.h"

namespace can {
namespace {

int count(const FakeLine& line, std::uint32_t id) {
  int num = 0;
  for (const CanFrame& frame : line.sent) num += frame.id == id ? 1 : 0;
  return num;
}

// From power-up to targets being followed, sixteen axes, nothing to complain about.
TEST(Cia402Bus, ComesUp) {
  BusRig rig(16);
  ASSERT_TRUE(rig.bring_up()) << rig.fault_names();
  EXPECT_TRUE(rig.bus->issues().empty());
  EXPECT_TRUE(rig.bus->faults().empty()) << rig.fault_names();
  const Capabilities can_do = rig.bus->capabilities();
  EXPECT_TRUE(can_do.hold_on_loss && can_do.torque_limit && can_do.sync &&
              can_do.absolute_position);
  ASSERT_TRUE(rig.bus->enable());
  ASSERT_TRUE(rig.run_until(BusPhase::kEnabled, 200)) << rig.fault_names();
  rig.cycle();
  for (AxisTarget& target : rig.targets) target.position_rad = 1.25;
  rig.run_ms(30);
  for (const ScriptedDrive& drive : rig.drives) EXPECT_EQ(drive.position, 1250);
  for (const AxisFeedback& axis : rig.feedback) {
    EXPECT_EQ(axis.position_rad, 1.25);
    EXPECT_EQ(axis.torque_Nm, 2.0);
    EXPECT_TRUE(axis.fresh);
  }
}

// The first frame is sent only after 300 ms of listening, and before configure() never.
TEST(Cia402Bus, ListensFirst) {
  BusRig rig(1);
  rig.build();
  rig.run_ms(500);
  EXPECT_TRUE(rig.line.sent.empty());
  rig.bus->configure();
  rig.run_ms(290);
  EXPECT_TRUE(rig.line.sent.empty());
  rig.run_ms(50);
  EXPECT_FALSE(rig.line.sent.empty());
}

// The objects that decide about falling have the contract's values in the drive.
TEST(Cia402Bus, WritesTheContract) {
  BusRig rig(1);
  rig.params.axes[0].sign = -1;
  rig.params.axes[0].offset_rad = 0.5;
  ASSERT_TRUE(rig.bring_up());
  const ScriptedDrive& drive = rig.drives[0];
  struct Row {
    std::uint16_t index;
    std::uint8_t subindex;
    std::uint32_t value;
  };
  const Row rows[] = {
      {0x6060, 0, 8},
      {0x60C2, 1, 10},
      {0x60C2, 2, 0xFD},
      {0x605A, 0, 6},
      {0x6007, 0, 3},
      {0x605E, 0, 2},
      {0x1016, 1, 0x007F0096},
      {0x1017, 0, 100},
      {0x1029, 1, 1},
      {0x1006, 0, 10000},
      {0x6072, 0, 1500},
      {0x6066, 0, 50},
      {0x607F, 0, 2500},
      {0x60C5, 0, 10000},
      {0x6085, 0, 20000},
      {0x1400, 1, 0x201},
      {0x1400, 2, 1},
      {0x1400, 5, 30},
      {0x1600, 0, 3},
      {0x1600, 1, 0x60400010},
      {0x1600, 2, 0x607A0020},
      {0x1600, 3, 0x60720010},
      {0x1800, 1, 0x181},
      {0x1800, 2, 1},
      {0x1A00, 0, 3},
      {0x1A00, 1, 0x60410010},
      {0x1A00, 2, 0x60640020},
      {0x1A00, 3, 0x60770010},
      {0x1801, 1, 0x281},
      {0x1801, 2, 255},
      {0x1801, 5, 100},
      {0x1A01, 1, 0x603F0010},
      {0x1A01, 2, 0x60610008},
      {0x1A01, 3, 0x60FD0020},
      // -(2.0 - 0.5) * 1000 and -(-2.0 - 0.5) * 1000: a turned axis swaps its limits.
      {0x607D, 1, static_cast<std::uint32_t>(-1500)},
      {0x607D, 2, 2500},
  };
  for (const Row& row : rows) {
    EXPECT_EQ(drive.object(row.index, row.subindex), row.value) << std::hex << row.index;
  }
}

// The first target that an enabled drive sees is where it stands.
TEST(Cia402Bus, FirstTargetIsMeasured) {
  BusRig rig(3);
  for (int i = 0; i < 3; ++i) rig.drives[static_cast<std::size_t>(i)].position = 100 * i - 77;
  ASSERT_TRUE(rig.bring_to_enabled());
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(rig.drives[static_cast<std::size_t>(i)].first_enabled_target(), 100 * i - 77);
  }
}

// Each cycle: all RPDOs, then SYNC, nothing behind it.
TEST(Cia402Bus, SyncComesLast) {
  BusRig rig(4);
  ASSERT_TRUE(rig.bring_to_enabled());
  rig.polls_between = false;
  rig.line.sent.clear();
  AxisFeedback unused[4];
  rig.bus->exchange(rig.time_us, {rig.time_us, rig.targets}, unused);
  std::string order;
  for (const CanFrame& frame : rig.line.sent) {
    if (frame.id != 0x77F) order += hex(frame).substr(0, 3) + " ";
  }
  EXPECT_EQ(order, "201 202 203 204 080 ");
}

// The master's heartbeat is never older than 50 ms plus a cycle, in every phase after listening.
TEST(Cia402Bus, HeartbeatGoesOn) {
  BusRig rig(2);
  ASSERT_TRUE(rig.bring_to_enabled());
  const int before = count(rig.line, 0x77F);
  rig.run_ms(1000);
  EXPECT_GE(count(rig.line, 0x77F) - before, 20);
  EXPECT_LE(count(rig.line, 0x77F) - before, 25);
}

// An abort of an object that no drive may lack forbids motion and says which object and why.
TEST(Cia402Bus, AbortForbidsMotion) {
  BusRig rig(2);
  rig.drives[0].lack(0x607D, 2);
  EXPECT_FALSE(rig.bring_up());
  EXPECT_EQ(rig.bus->phase(), BusPhase::kIdle);
  EXPECT_TRUE(rig.has(FaultCause::kConfiguration, 0));
  EXPECT_FALSE(rig.bus->enable());
  EXPECT_EQ(describe(rig.bus->issues()[0]),
            "axis 0: 607Dh:2 software position limit, maximum: subindex does not exist (abort "
            "06090011h)");
  EXPECT_EQ(count(rig.line, 0x201), 0);
}

// A value that reads back differently forbids motion.
TEST(Cia402Bus, MismatchForbidsMotion) {
  BusRig rig(1);
  rig.drives[0].reads_back[ScriptedDrive::key(0x6065, 0)] = 99;
  EXPECT_FALSE(rig.bring_up());
  ASSERT_EQ(rig.bus->issues().size(), 1U);
  EXPECT_EQ(describe(rig.bus->issues()[0]),
            "axis 0: 6065h:0 following error window: wrote 100, reads back 99");
}

// A drive that is not there is named after three unanswered requests; a dead object likewise.
TEST(Cia402Bus, SilenceWhileConfiguringIsNamed) {
  BusRig absent(2);
  absent.drives[1].is_silent = true;
  absent.build();
  absent.cycle();
  absent.bus->configure();
  absent.cycle();
  EXPECT_TRUE(absent.run_until(BusPhase::kIdle, 1600));  // 300 ms listening, 3 x 400 ms asking
  ASSERT_EQ(absent.bus->issues().size(), 1U);
  EXPECT_EQ(describe(absent.bus->issues()[0]), "axis 1: 1000h:0 device type: no answer");

  BusRig dead(1);
  dead.drives[0].dead_objects.insert(ScriptedDrive::key(0x605E, 0));
  EXPECT_FALSE(dead.bring_up());
  ASSERT_EQ(dead.bus->issues().size(), 1U);
  EXPECT_EQ(dead.bus->issues()[0].index, 0x605E);
}

// An object that the installation declared optional may be absent.
TEST(Cia402Bus, DeclaredOptionalObjectMayBeAbsent) {
  BusRig rig(1);
  rig.params.optional_objects = {{0x605E, 0}};
  rig.drives[0].lack(0x605E);
  EXPECT_TRUE(rig.bring_up());
  EXPECT_EQ(rig.bus->issues().size(), 1U);
}

// An encoder that contradicts counts_per_rad forbids motion; one that agrees, is not told or reads
// 0 passes.
TEST(Cia402Bus, EncoderResolutionIsCompared) {
  BusRig agrees(1);
  agrees.drives[0].set_object(0x608F, 1, 6283);
  EXPECT_TRUE(agrees.bring_up());
  BusRig says_nothing(1);
  says_nothing.drives[0].set_object(0x608F, 1, 0);
  EXPECT_TRUE(says_nothing.bring_up());
  BusRig differs(1);
  differs.drives[0].set_object(0x608F, 1, 4096);
  EXPECT_FALSE(differs.bring_up());
  EXPECT_EQ(differs.bus->issues()[0].index, 0x608F);
}

// Quick stop holds: torque stays on, and enabling again starts from the measured position.
TEST(Cia402Bus, QuickStopHoldsAndComesBack) {
  BusRig rig(2);
  ASSERT_TRUE(rig.bring_to_enabled());
  rig.run_ms(50);
  ASSERT_TRUE(rig.bus->stop(StopKind::kQuickStop));
  rig.run_ms(100);
  for (ScriptedDrive& drive : rig.drives) {
    EXPECT_EQ(drive.control_word(), 0x0B);
    EXPECT_EQ(drive.status_word() & 0x6F, 0x07);
    drive.position = 321;
  }
  EXPECT_TRUE(rig.bus->faults().empty()) << rig.fault_names();
  rig.run_ms(20);
  ASSERT_TRUE(rig.bus->enable());
  ASSERT_TRUE(rig.run_until(BusPhase::kEnabled, 200));
  for (const ScriptedDrive& drive : rig.drives) EXPECT_EQ(drive.first_enabled_target(), 321);
}

// stop(kHold) repeats the last targets with torque on, whatever is asked afterwards.
TEST(Cia402Bus, HoldRepeatsTheLastTargets) {
  BusRig rig(1);
  ASSERT_TRUE(rig.bring_to_enabled());
  rig.cycle();
  rig.targets[0].position_rad = 0.7;
  rig.run_ms(20);
  rig.bus->stop(StopKind::kHold);
  rig.targets[0].position_rad = 1.9;
  rig.run_ms(200);
  EXPECT_EQ(rig.drives[0].target(), 700);
  EXPECT_EQ(rig.drives[0].control_word(), 0x0F);
}

// disable() walks down step by step to no torque.
TEST(Cia402Bus, DisableWalksDown) {
  BusRig rig(1);
  ASSERT_TRUE(rig.bring_to_enabled());
  const std::size_t before = rig.line.sent.size();
  rig.bus->disable();
  ASSERT_TRUE(rig.run_until(BusPhase::kReady, 500));
  std::string words;
  for (std::size_t i = before; i < rig.line.sent.size(); ++i) {
    const CanFrame& frame = rig.line.sent[i];
    if (frame.id == 0x201) words += std::to_string(frame.data[0]) + " ";
  }
  EXPECT_EQ(words.substr(0, 6), "7 6 0 ");
  EXPECT_EQ(rig.drives[0].status_word(), 0x0240);
  EXPECT_TRUE(rig.bus->faults().empty());
}

// A drive that does not walk is named; those already enabled keep holding.
TEST(Cia402Bus, EnableTimeoutHoldsTheOthers) {
  BusRig rig(2);
  ASSERT_TRUE(rig.bring_up());
  rig.drives[1].ignores_control_word = true;
  rig.bus->enable();
  EXPECT_TRUE(rig.run_until(BusPhase::kStopped, 2000));
  EXPECT_TRUE(rig.has(FaultCause::kEnableTimeout, 1));
  rig.run_ms(100);
  EXPECT_EQ(rig.drives[0].control_word(), 0x0F);
  EXPECT_FALSE(rig.bus->enable());
}

// rearm() resets a drive fault by a rising edge and is ready again; motion needs enable(). With
// and without polls between the cycles.
TEST(Cia402Bus, RearmResetsFaultsByEdge) {
  for (const bool polls : {true, false}) {
    BusRig rig(2);
    rig.polls_between = polls;
    ASSERT_TRUE(rig.bring_to_enabled());
    rig.drives[0].fail();
    rig.run_ms(50);
    EXPECT_TRUE(rig.has(FaultCause::kLeftOperationEnabled, 0));
    EXPECT_EQ(rig.drives[0].num_fault_resets(), 0);
    ASSERT_TRUE(rig.bus->rearm());
    ASSERT_TRUE(rig.run_until(BusPhase::kReady, 1000)) << rig.fault_names();
    EXPECT_EQ(rig.drives[0].num_fault_resets(), 1);
    EXPECT_TRUE(rig.bus->faults().empty()) << rig.fault_names();
    EXPECT_EQ(rig.drives[0].status_word(), 0x0240);
    EXPECT_EQ(rig.drives[1].status_word() & 0x6F, 0x07);  // holds by itself, never let go
    ASSERT_TRUE(rig.bus->enable());
    EXPECT_TRUE(rig.run_until(BusPhase::kEnabled, 500)) << rig.fault_names();
  }
}

// A bus fault, after which the drives report a fault of their own: one rearm() mends both.
TEST(Cia402Bus, RearmAfterBusFaultWithFailedDrives) {
  BusRig rig(2);
  ASSERT_TRUE(rig.bring_to_enabled());
  CanFrame bus_off;
  bus_off.id = 0x40;
  bus_off.error = true;
  bus_off.dlc = 8;
  rig.line.put(bus_off);
  rig.cycle();
  EXPECT_EQ(rig.bus->phase(), BusPhase::kFaulted);
  for (ScriptedDrive& drive : rig.drives) drive.fail();
  rig.line.put(from_hex("081#3081110000000000"));
  rig.run_ms(500);
  ASSERT_TRUE(rig.bus->rearm());
  rig.line.put(from_hex("081#3081110000000000"));
  rig.run_ms(100);
  ASSERT_TRUE(rig.run_until(BusPhase::kReady, 2000)) << rig.fault_names();
  EXPECT_TRUE(rig.bus->faults().empty()) << rig.fault_names();
  EXPECT_TRUE(rig.bus->enable());
}

// A fault that cannot be reset is told again; the drive is not enabled.
TEST(Cia402Bus, FaultThatStays) {
  BusRig rig(1);
  ASSERT_TRUE(rig.bring_to_enabled());
  rig.drives[0].fail();
  rig.drives[0].ignores_control_word = true;
  rig.run_ms(50);
  ASSERT_TRUE(rig.bus->rearm());
  ASSERT_TRUE(rig.run_until(BusPhase::kReady, 3000));
  EXPECT_TRUE(rig.has(FaultCause::kEnableTimeout, 0));
  EXPECT_FALSE(rig.bus->enable());
}

// Requests that make no sense in a phase are refused and change nothing.
TEST(Cia402Bus, RefusesRequestsOutOfPhase) {
  BusRig rig(1);
  rig.build();
  EXPECT_FALSE(rig.bus->enable());
  EXPECT_FALSE(rig.bus->disable());
  EXPECT_FALSE(rig.bus->stop(StopKind::kQuickStop));
  EXPECT_EQ(rig.bus->phase(), BusPhase::kIdle);
  ASSERT_TRUE(rig.bring_to_enabled());
  EXPECT_FALSE(rig.bus->configure());
  EXPECT_EQ(rig.bus->phase(), BusPhase::kEnabled);
}

}  // namespace
}  // namespace can
