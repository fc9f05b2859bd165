// SPDX-License-Identifier: BSD-3-Clause
// What the CiA 402 bus makes of drives that go wrong and of targets that are no targets: each cause
// once, named with its axis, within its bound. Faults of the line: cia402_line_faults_test.cpp.
#include <cmath>
#include <limits>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "bus_rig.h"

namespace can {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Three missed states: the axis is silent after 30 ms and a cycle, not before.
TEST(Cia402Faults, SilentAxis) {
  BusRig rig(2);
  ASSERT_TRUE(rig.bring_to_enabled());
  rig.drives[1].is_mute_on_sync = true;
  rig.run_ms(30);  // the state of the cycle before was still heard in the first of these
  EXPECT_FALSE(rig.has(FaultCause::kSilent, 1));
  EXPECT_EQ(rig.feedback[1].missed_cycles, 2);
  rig.run_ms(10);
  EXPECT_TRUE(rig.has(FaultCause::kSilent, 1));
  EXPECT_FALSE(rig.has(FaultCause::kSilent, 0));
  EXPECT_EQ(rig.bus->phase(), BusPhase::kEnabled);  // the others are still served
}

// Two missed states are no fault.
TEST(Cia402Faults, TwoMissedStatesAreForgiven) {
  BusRig rig(1);
  ASSERT_TRUE(rig.bring_to_enabled());
  for (int i = 0; i < 20; ++i) {
    rig.drives[0].is_mute_on_sync = true;
    rig.run_ms(20);
    rig.drives[0].is_mute_on_sync = false;
    rig.run_ms(10);
  }
  EXPECT_TRUE(rig.bus->faults().empty()) << rig.fault_names();
}

// A heartbeat that stops is noticed within 260 ms although states still arrive.
TEST(Cia402Faults, HeartbeatLost) {
  BusRig rig(2);
  ASSERT_TRUE(rig.bring_to_enabled());
  rig.run_ms(200);
  rig.drives[0].has_heartbeat = false;
  rig.run_ms(150);
  EXPECT_TRUE(rig.bus->faults().empty());
  rig.run_ms(120);
  EXPECT_TRUE(rig.has(FaultCause::kHeartbeatLost, 0));
  EXPECT_EQ(rig.bus->faults().size(), 1U);
}

// A drive that restarts is told nothing more and is never enabled again by itself.
TEST(Cia402Faults, UnexpectedBootUp) {
  BusRig rig(2);
  ASSERT_TRUE(rig.bring_to_enabled());
  rig.line.put(rig.drives[0].boot_up());
  rig.cycle();
  EXPECT_TRUE(rig.has(FaultCause::kUnexpectedBootUp, 0));
  const std::size_t before = rig.line.sent.size();
  rig.run_ms(100);
  for (std::size_t i = before; i < rig.line.sent.size(); ++i) {
    EXPECT_NE(rig.line.sent[i].id, 0x201U);
  }
  EXPECT_EQ(rig.drives[1].control_word(), 0x0F);
  ASSERT_TRUE(rig.bus->rearm());
  rig.run_ms(100);
  EXPECT_EQ(rig.bus->phase(), BusPhase::kIdle);         // it has to be configured anew
  EXPECT_EQ(rig.drives[1].status_word() & 0x6F, 0x07);  // holds by itself meanwhile
  ASSERT_TRUE(rig.bus->configure());
  EXPECT_TRUE(rig.run_until(BusPhase::kReady, 3000)) << rig.fault_names();
}

// An axis that broke before is not enabled with the others, and the bus does not come up.
TEST(Cia402Faults, BrokenAxisIsNotEnabled) {
  BusRig rig(2);
  ASSERT_TRUE(rig.bring_up());
  rig.line.put(from_hex("081#1186210000000000"));
  rig.cycle();
  ASSERT_TRUE(rig.has(FaultCause::kEmergency, 0));
  rig.bus->enable();
  for (int i = 0; i < 100; ++i) {
    rig.cycle();
    EXPECT_NE(rig.drives[0].control_word() & 0x0F, 0x0F) << "cycle " << i;
    EXPECT_NE(rig.bus->phase(), BusPhase::kEnabled);
  }
}

// Network state other than operational in a heartbeat.
TEST(Cia402Faults, LeftOperational) {
  BusRig rig(1);
  ASSERT_TRUE(rig.bring_to_enabled());
  rig.line.put(from_hex("701#7F"));
  rig.cycle();
  EXPECT_TRUE(rig.has(FaultCause::kLeftOperational, 0));
}

// Any drive state but operation enabled, once enabled, is a fault in the very next cycle.
TEST(Cia402Faults, LeftOperationEnabled) {
  for (const int status : {0x0240, 0x0221, 0x0223, 0x0207, 0x020F, 0x0208, 0x0200}) {
    BusRig rig(2);
    ASSERT_TRUE(rig.bring_to_enabled());
    rig.drives[1].ignores_control_word = true;
    rig.drives[1].set_status_word(static_cast<std::uint16_t>(status));
    rig.run_ms(20);
    EXPECT_TRUE(rig.has(FaultCause::kLeftOperationEnabled, 1)) << std::hex << status;
    EXPECT_FALSE(rig.has(FaultCause::kLeftOperationEnabled, 0));
    rig.run_ms(100);
    // Not walked up again, and no fault reset without rearm().
    EXPECT_EQ(rig.drives[1].control_word() & 0x80, 0);
    EXPECT_NE(rig.drives[1].control_word(), 0x0F) << std::hex << status;
  }
}

// A statusword outside the standard does not make the master drop the limb.
TEST(Cia402Faults, UnknownStateKeepsTheLastWord) {
  BusRig rig(1);
  ASSERT_TRUE(rig.bring_to_enabled());
  rig.drives[0].ignores_control_word = true;
  rig.drives[0].set_status_word(0x0225);
  rig.run_ms(100);
  EXPECT_EQ(rig.drives[0].control_word(), 0x0F);
  EXPECT_TRUE(rig.has(FaultCause::kLeftOperationEnabled, 0));
}

// An emergency names its code; voltage and temperature are warnings while the drive stays enabled.
TEST(Cia402Faults, Emergencies) {
  struct Row {
    const char* frame;
    FaultCause cause;
    std::uint32_t detail;
  };
  const Row rows[] = {{"081#1186210000000000", FaultCause::kEmergency, 0x8611},
                      {"081#2082010000000000", FaultCause::kEmergency, 0x8220},
                      {"081#2031040000000000", FaultCause::kWarning, 0x3120},
                      {"081#1043080000000000", FaultCause::kWarning, 0x4310}};
  for (const Row& row : rows) {
    BusRig rig(1);
    ASSERT_TRUE(rig.bring_to_enabled());
    rig.line.put(from_hex(row.frame));
    rig.cycle();
    ASSERT_EQ(rig.bus->faults().size(), 1U) << row.frame;
    EXPECT_EQ(rig.bus->faults()[0].cause, row.cause);
    EXPECT_EQ(rig.bus->faults()[0].detail, row.detail);
    EXPECT_EQ(rig.feedback[0].error_code, row.detail);
  }
}

// Re-arming keeps still for longer than drives wait for targets: what they say of that is no fault,
// anything else is.
TEST(Cia402Faults, SilenceOfRearmingIsNoFault) {
  for (const char* said :
       {"081#5082110000000000", "081#3081110000000000", "081#1186210000000000"}) {
    const bool is_silence = std::string_view(said).substr(6, 2) != "86";
    BusRig rig(1);
    ASSERT_TRUE(rig.bring_to_enabled());
    rig.line.put(from_hex(said));
    rig.cycle();
    ASSERT_TRUE(rig.has(FaultCause::kEmergency, 0)) << said;
    ASSERT_TRUE(rig.bus->rearm());
    ASSERT_TRUE(rig.run_until(BusPhase::kRearming, 500)) << said;
    rig.line.put(from_hex(said));
    ASSERT_TRUE(rig.run_until(BusPhase::kReady, 500)) << said;
    EXPECT_EQ(rig.bus->faults().empty(), is_silence) << said << rig.fault_names();
    EXPECT_EQ(rig.bus->enable(), is_silence) << said;
  }
}

// "Error gone" is no fault.
TEST(Cia402Faults, ClearedEmergencyIsNoFault) {
  BusRig rig(1);
  ASSERT_TRUE(rig.bring_to_enabled());
  rig.line.put(from_hex("081#0000000000000000"));
  rig.cycle();
  EXPECT_TRUE(rig.bus->faults().empty());
}

// An emergency while configuring forbids to go on, even if no object was refused.
TEST(Cia402Faults, EmergencyWhileConfiguringForbidsMotion) {
  BusRig rig(1);
  rig.drives[0].dead_objects.insert(ScriptedDrive::key(0x1400, 5));  // makes it last 1.2 s longer
  rig.build();
  rig.cycle();
  rig.bus->configure();
  ASSERT_TRUE(rig.run_until(BusPhase::kConfiguring, 1000));
  rig.line.put(from_hex("081#2082010000000000"));
  rig.run_ms(2000);
  EXPECT_EQ(rig.bus->phase(), BusPhase::kIdle);
  EXPECT_TRUE(rig.has(FaultCause::kEmergency, 0));
}

// The controller was away and the drives stopped by themselves: the first frames afterwards only
// ask, so that the stop is seen and not undone.
TEST(Cia402Faults, PauseOfTheControllerIsNotUndone) {
  for (const bool polls : {true, false}) {
    BusRig rig(2);
    rig.polls_between = polls;
    ASSERT_TRUE(rig.bring_to_enabled());
    rig.run_ms(50);
    rig.time_us += 200'000;
    for (ScriptedDrive& drive : rig.drives) drive.set_status_word(0x0207);
    rig.run_ms(100);
    for (const ScriptedDrive& drive : rig.drives) {
      EXPECT_EQ(drive.status_word(), 0x0207);
      EXPECT_EQ(drive.control_word(), 0x0B);
    }
    EXPECT_TRUE(rig.has(FaultCause::kLeftOperationEnabled, 0));
    EXPECT_TRUE(rig.has(FaultCause::kLeftOperationEnabled, 1));
  }
}

// The same when the drives answer later than a cycle: until each has said its state anew it is told
// nothing, since its last word before the pause would undo the stop.
TEST(Cia402Faults, LateAnswersAfterAPauseAreAwaited) {
  BusRig rig(2);
  ASSERT_TRUE(rig.bring_to_enabled());
  rig.run_ms(50);
  rig.time_us += 200'000;
  for (ScriptedDrive& drive : rig.drives) {
    drive.set_status_word(0x0207);
    drive.is_mute_on_sync = true;
  }
  rig.run_ms(20);
  for (ScriptedDrive& drive : rig.drives) drive.is_mute_on_sync = false;
  rig.run_ms(50);
  for (const ScriptedDrive& drive : rig.drives) {
    EXPECT_EQ(drive.status_word(), 0x0207);
    EXPECT_EQ(drive.control_word(), 0x0B);
  }
}

// A drive that neither heard nor spoke has stopped by itself meanwhile. When it listens again it is
// told to go on holding, not to follow the targets from before.
TEST(Cia402Faults, SilentDriveComesBackStopped) {
  BusRig rig(2);
  ASSERT_TRUE(rig.bring_to_enabled());
  rig.drives[1].latches_on_sync = true;
  rig.drives[1].is_silent = true;
  rig.run_ms(200);
  ASSERT_TRUE(rig.has(FaultCause::kSilent, 1));
  rig.drives[1].set_status_word(0x0207);
  rig.drives[1].is_silent = false;
  for (int i = 0; i < 10; ++i) {
    rig.cycle();
    EXPECT_EQ(rig.drives[1].status_word(), 0x0207) << i;
  }
  EXPECT_EQ(rig.drives[0].control_word(), 0x0F);
}

// Enabling that fails while the enabling words are on their way: drives that held by themselves
// hold again after one cycle, and are not told 0Fh and 0Bh in turns.
TEST(Cia402Faults, FailedEnablingLeavesDrivesStopped) {
  BusRig rig(2);
  ASSERT_TRUE(rig.bring_to_enabled());
  rig.bus->stop(StopKind::kQuickStop);
  rig.run_ms(50);
  for (ScriptedDrive& drive : rig.drives) drive.latches_on_sync = true;
  ASSERT_TRUE(rig.bus->enable());
  rig.cycle();
  rig.line.put(from_hex("082#1186210000000000"));
  rig.run_ms(30);
  EXPECT_EQ(rig.bus->phase(), BusPhase::kStopped);
  for (int i = 0; i < 10; ++i) {
    rig.cycle();
    for (const ScriptedDrive& drive : rig.drives) EXPECT_EQ(drive.status_word(), 0x0207) << i;
  }
}

// Targets that are no numbers, do not fit or are old are refused whole: all axes keep the last.
TEST(Cia402Faults, RefusedTargets) {
  struct Row {
    AxisTarget target;
    std::int64_t age_us;
    int axis;
  };
  const Row rows[] = {
      {{kNan, 0, 0, 1}, 0, 1},   {{kInfinity, 0, 0, 1}, 0, 1}, {{-kInfinity, 0, 0, 1}, 0, 1},
      {{1e10, 0, 0, 1}, 0, 1},   {{1.0, kNan, 0, 1}, 0, 1},    {{1.0, 1e8, 0, 1}, 0, 1},
      {{1.0, 0, kNan, 1}, 0, 1}, {{1.0, 0, 1e9, 1}, 0, 1},     {{1.0, 0, 0, kNan}, 0, 1},
      {{1.0, 0, 0, -1.0}, 0, 1}, {AxisTarget{}, 0, 1},         {{1.0, 0, 0, 1}, 20'001, -1},
      {{1.0, 0, 0, 1}, -1, -1}};
  for (const Row& row : rows) {
    BusRig rig(2);
    ASSERT_TRUE(rig.bring_to_enabled());
    rig.cycle();
    rig.follows = false;
    rig.targets[0].position_rad = 1.5;
    rig.targets[1] = row.target;
    rig.targets_age_us = row.age_us;
    rig.run_ms(50);
    EXPECT_TRUE(rig.has(FaultCause::kTargetRefused, row.axis)) << row.target.position_rad;
    for (const ScriptedDrive& drive : rig.drives) {
      EXPECT_EQ(drive.target(), 1000);
      EXPECT_EQ(drive.control_word(), 0x0F);
    }
  }
}

// The largest targets that fit pass; the torque limit never exceeds the axis' own.
TEST(Cia402Faults, ExtremeTargetsThatFit) {
  BusRig rig(1);
  ASSERT_TRUE(rig.bring_to_enabled());
  rig.cycle();
  rig.targets[0] = {2147483.647, 0, 0, kInfinity};
  rig.run_ms(20);
  EXPECT_EQ(rig.drives[0].target(), 2147483647);
  EXPECT_EQ(rig.drives[0].max_torque(), 1500);
  rig.targets[0] = {-2147483.648, 0, 0, 0.0199};
  rig.run_ms(20);
  EXPECT_EQ(rig.drives[0].target(), INT32_MIN);
  EXPECT_EQ(rig.drives[0].max_torque(), 0);
  EXPECT_TRUE(rig.bus->faults().empty()) << rig.fault_names();
}

// A fault that stays is told once; a recorder keeps what was said and sent.
TEST(Cia402Faults, EachFaultOnceAndRecorded) {
  BusRig rig(1);
  ASSERT_TRUE(rig.bring_to_enabled());
  for (int i = 0; i < 100; ++i) {
    rig.line.put(from_hex("081#1186210000000000"));
    rig.cycle();
  }
  EXPECT_EQ(rig.bus->faults().size(), 1U);
  std::ostringstream events;
  rig.recorder.write_events(events);
  EXPECT_NE(events.str().find("phase enabled"), std::string::npos);
  EXPECT_NE(events.str().find("fault axis 0 emergency 8611h"), std::string::npos);
  std::ostringstream frames;
  rig.recorder.write_candump(frames, "can0");
  EXPECT_NE(frames.str().find(" can0 081#1186210000000000\n"), std::string::npos);
}

}  // namespace
}  // namespace can
