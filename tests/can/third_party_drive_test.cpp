// SPDX-License-Identifier: BSD-3-Clause
// Drives that others make: what they may lack and still move, what is named, and that no frame ever
// has another length than the drive was brought to.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "bus_rig.h"

namespace can {
namespace {

std::string issues_of(const ServoBus& bus) {
  std::string text;
  for (const ObjectIssue& issue : bus.issues()) text += describe(issue) + "\n";
  return text;
}

void expect_length(const BusRig& rig, std::uint32_t id, int num_bytes) {
  int num = 0;
  for (const CanFrame& frame : rig.line.sent) {
    if (frame.id != id) continue;
    ++num;
    EXPECT_EQ(frame.dlc, num_bytes);
  }
  EXPECT_GT(num, 0);
}

// Without 6007h, 605Ah or 1016h a drive comes up, but holding on loss is not claimed and each
// missing object is named.
TEST(ThirdPartyDrive, MissingHoldOnLossIsTold) {
  for (const auto& [index, subindex] :
       {std::pair{0x6007, 0}, std::pair{0x605A, 0}, std::pair{0x1016, 1}}) {
    BusRig rig(2);
    rig.drives[1].lack(static_cast<std::uint16_t>(index), static_cast<std::uint8_t>(subindex));
    ASSERT_TRUE(rig.bring_up()) << rig.fault_names();
    EXPECT_FALSE(rig.bus->capabilities().hold_on_loss);
    EXPECT_TRUE(rig.bus->capabilities().torque_limit);
    ASSERT_EQ(rig.bus->issues().size(), 1U);
    EXPECT_EQ(rig.bus->issues()[0].axis, 1);
    EXPECT_EQ(rig.bus->issues()[0].index, index);
    EXPECT_FALSE(rig.bus->issues()[0].forbids_motion);
  }
  BusRig rig(1);
  rig.drives[0].lack(0x6007);
  rig.drives[0].lack(0x605A);
  ASSERT_TRUE(rig.bring_up());
  EXPECT_EQ(rig.bus->issues().size(), 2U) << issues_of(*rig.bus);
}

// A small drive as they are sold: neither hold on loss nor torque nor most limits. It comes up with
// the 6-byte frames, each lack named, follows targets, and never gets a frame of a wrong length.
TEST(ThirdPartyDrive, SmallDriveMovesOnTheGround) {
  BusRig rig(1);
  ScriptedDrive& drive = rig.drives[0];
  for (const int index : {0x1006, 0x603F, 0x6007, 0x6066, 0x6072, 0x6077, 0x607F, 0x6080, 0x60C5}) {
    drive.lack(static_cast<std::uint16_t>(index));
  }
  drive.lack(0x1400, 5);
  drive.set_object(0x605E, 0, 2);
  drive.read_only.insert(ScriptedDrive::key(0x605E, 0));
  drive.set_object(0x608F, 1, 0);
  drive.set_status_word(0x0000);  // not ready, until it is told anything
  ASSERT_TRUE(rig.bring_to_enabled()) << issues_of(*rig.bus) << rig.fault_names();
  EXPECT_FALSE(rig.bus->capabilities().hold_on_loss);
  EXPECT_FALSE(rig.bus->capabilities().torque_limit);
  EXPECT_TRUE(std::isnan(rig.feedback[0].torque_Nm));
  std::string named;
  for (const ObjectIssue& issue : rig.bus->issues()) {
    EXPECT_FALSE(issue.forbids_motion) << describe(issue);
    named += describe(issue).substr(8, 6) + " ";
  }
  EXPECT_EQ(named, "607Fh: 6080h: 60C5h: 6066h: 6072h: 6077h: 6007h: 1006h: 1A01h: 1400h: ");
  rig.cycle();
  rig.targets[0].position_rad = 1.25;
  rig.run_ms(100);
  EXPECT_EQ(drive.position, 1250);
  EXPECT_EQ(drive.num_wrong_lengths(), 0);
  EXPECT_TRUE(rig.bus->faults().empty()) << rig.fault_names();
  expect_length(rig, 0x201, 6);
}

// Where the configuration declares that there is no torque, nothing is asked and nothing told.
TEST(ThirdPartyDrive, DeclaredWithoutTorque) {
  BusRig rig(1);
  rig.params.axes[0].has_torque = false;
  rig.drives[0].lack(0x6072);
  rig.drives[0].lack(0x6077);
  ASSERT_TRUE(rig.bring_to_enabled()) << rig.fault_names();
  EXPECT_TRUE(rig.bus->issues().empty()) << issues_of(*rig.bus);
  EXPECT_FALSE(rig.bus->capabilities().torque_limit);
  EXPECT_EQ(rig.drives[0].num_wrong_lengths(), 0);
  expect_length(rig, 0x201, 6);
}

// Limiting and measuring torque are two things: a drive that does one of them gets one long frame.
TEST(ThirdPartyDrive, HalfOfTheTorque) {
  BusRig measures(1);
  measures.drives[0].lack(0x6072);
  ASSERT_TRUE(measures.bring_to_enabled()) << measures.fault_names();
  EXPECT_FALSE(measures.bus->capabilities().torque_limit);
  EXPECT_EQ(measures.feedback[0].torque_Nm, 2.0);
  expect_length(measures, 0x201, 6);

  BusRig limits(1);
  limits.drives[0].lack(0x6077);
  ASSERT_TRUE(limits.bring_to_enabled()) << limits.fault_names();
  EXPECT_FALSE(limits.bus->capabilities().torque_limit);
  EXPECT_TRUE(std::isnan(limits.feedback[0].torque_Nm));
  expect_length(limits, 0x201, 8);
  EXPECT_EQ(measures.drives[0].num_wrong_lengths() + limits.drives[0].num_wrong_lengths(), 0);
}

// Torque objects that exist but may not be in a PDO: the short frames all the same.
TEST(ThirdPartyDrive, TorqueThatCannotBeMapped) {
  BusRig rig(1);
  rig.drives[0].unmappable = {0x6072, 0x6077};
  ASSERT_TRUE(rig.bring_to_enabled()) << rig.fault_names();
  EXPECT_FALSE(rig.bus->capabilities().torque_limit);
  EXPECT_EQ(rig.bus->issues().size(), 2U) << issues_of(*rig.bus);
  EXPECT_EQ(rig.drives[0].object(0x1600, 0), 2U);
  EXPECT_EQ(rig.drives[0].object(0x1A00, 0), 2U);
  EXPECT_EQ(rig.drives[0].num_wrong_lengths(), 0);
}

// Limits that the controller keeps too may be absent: named, and nothing else changes. With another
// value than asked for they forbid motion.
TEST(ThirdPartyDrive, LimitsMayBeAbsentButNotOther) {
  struct Row {
    std::uint16_t index;
    std::uint8_t subindex;
  };
  for (const Row row : {Row{0x1006, 0}, Row{0x1029, 1}, Row{0x607F, 0}, Row{0x6080, 0},
                        Row{0x60C5, 0}, Row{0x6085, 0}, Row{0x6065, 0}, Row{0x6066, 0}}) {
    BusRig absent(1);
    absent.drives[0].lack(row.index, row.subindex);
    ASSERT_TRUE(absent.bring_to_enabled()) << absent.fault_names();
    ASSERT_EQ(absent.bus->issues().size(), 1U);
    EXPECT_EQ(absent.bus->issues()[0].index, row.index);
    EXPECT_TRUE(absent.bus->capabilities().hold_on_loss);

    BusRig other(1);
    other.drives[0].reads_back[ScriptedDrive::key(row.index, row.subindex)] = 77;
    EXPECT_FALSE(other.bring_up());
    EXPECT_EQ(other.bus->issues().size(), 1U);

    BusRig broken(1);
    broken.drives[0].aborts[ScriptedDrive::key(row.index, row.subindex)] = 0x06060000;
    EXPECT_FALSE(broken.bring_up()) << "a hardware error is no absence";
  }
}

// Any node id that CANopen allows, in any order.
TEST(ThirdPartyDrive, OtherNodeIds) {
  BusRig rig(0);
  for (const int node : {0x22, 126, 2, 100}) rig.add_axis(static_cast<std::uint8_t>(node));
  ASSERT_TRUE(rig.bring_to_enabled()) << rig.fault_names();
  rig.cycle();
  for (std::size_t i = 0; i < 4; ++i) rig.targets[i].position_rad = 0.1 * static_cast<double>(i);
  rig.run_ms(50);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(rig.drives[i].position, 100 * static_cast<std::int32_t>(i));
  }
  EXPECT_TRUE(rig.bus->faults().empty()) << rig.fault_names();
}

// PDOs that a drive does not let change: fine where they are what is asked for, else named.
TEST(ThirdPartyDrive, FixedPdos) {
  const auto fix = [](ScriptedDrive& drive, std::uint16_t index, std::uint8_t subindex,
                      std::uint32_t value) {
    drive.set_object(index, subindex, value);
    drive.read_only.insert(ScriptedDrive::key(index, subindex));
  };
  BusRig rig(1);
  ScriptedDrive& drive = rig.drives[0];
  fix(drive, 0x1400, 1, 0x201);
  fix(drive, 0x1800, 1, 0x40000181);
  fix(drive, 0x1801, 1, 0x281);
  fix(drive, 0x1600, 0, 3);
  fix(drive, 0x1600, 1, 0x60400010);
  fix(drive, 0x1600, 2, 0x607A0020);
  fix(drive, 0x1600, 3, 0x60720010);
  EXPECT_TRUE(rig.bring_to_enabled()) << issues_of(*rig.bus);
  EXPECT_TRUE(rig.bus->issues().empty()) << issues_of(*rig.bus);

  BusRig other(1);
  fix(other.drives[0], 0x1800, 1, 0x1C1);
  EXPECT_FALSE(other.bring_up());
  ASSERT_FALSE(other.bus->issues().empty());
  EXPECT_EQ(describe(other.bus->issues()[0]),
            "axis 0: 1800h:1 TPDO1: read-only object (abort 06010002h)");
}

// PDOs that a drive sends as delivered are switched off; what arrives before it is configured is no
// broken frame.
TEST(ThirdPartyDrive, PdosAsDelivered) {
  BusRig rig(1);
  rig.drives[0].set_object(0x1802, 1, 0x381);
  rig.drives[0].set_object(0x1803, 1, 0x481);
  rig.build();
  rig.cycle();
  rig.bus->configure();
  for (int i = 0; i < 30; ++i) {
    rig.line.put(from_hex("181#2100"));
    rig.line.put(from_hex("281#0000"));
    rig.cycle();
  }
  ASSERT_TRUE(rig.run_until(BusPhase::kReady, 2000)) << rig.fault_names();
  EXPECT_EQ(rig.bus->num_malformed(), 0U);
  EXPECT_EQ(rig.drives[0].object(0x1802, 1), 0x80000381);
  EXPECT_EQ(rig.drives[0].object(0x1803, 1), 0x80000481);
}

// A drive that takes 200 ms for each answer comes up; nothing is asked twice.
TEST(ThirdPartyDrive, SlowAnswers) {
  BusRig rig(1);
  rig.drives[0].sdo_delay_ms = 200;
  rig.build();
  rig.cycle();
  rig.bus->configure();
  ASSERT_TRUE(rig.run_until(BusPhase::kReady, 60'000)) << issues_of(*rig.bus);
  EXPECT_TRUE(rig.bus->issues().empty()) << issues_of(*rig.bus);
  EXPECT_TRUE(rig.bus->enable());
  EXPECT_TRUE(rig.run_until(BusPhase::kEnabled, 500));
}

// Found enabled by a master before this one: it is never without torque, is told to stop and hold,
// and is told to follow only after enable(), from where it stands.
TEST(ThirdPartyDrive, FoundEnabled) {
  BusRig rig(1);
  ScriptedDrive& drive = rig.drives[0];
  drive.run_with(0x0227);
  drive.position = 345;
  ASSERT_TRUE(rig.bring_up()) << rig.fault_names();
  for (int i = 0; i < 20; ++i) {
    rig.cycle();
    const int state = drive.status_word() & 0x6F;
    EXPECT_TRUE(state == 0x27 || state == 0x07) << std::hex << state;
    EXPECT_NE(drive.control_word() & 0x0F, 0x0F);
  }
  EXPECT_EQ(drive.status_word() & 0x6F, 0x07);
  EXPECT_EQ(drive.position, 345);
  ASSERT_TRUE(rig.bus->enable());
  ASSERT_TRUE(rig.run_until(BusPhase::kEnabled, 500)) << rig.fault_names();
  EXPECT_EQ(drive.first_enabled_target(), 345);
}

// The same drive without hold on loss: a quick stop might let it go, so it is kept as it is found.
TEST(ThirdPartyDrive, FoundEnabledWithoutHoldOnLoss) {
  BusRig rig(1);
  rig.drives[0].run_with(0x0227);
  rig.drives[0].lack(0x605A);
  ASSERT_TRUE(rig.bring_up()) << rig.fault_names();
  rig.run_ms(100);
  EXPECT_EQ(rig.drives[0].status_word() & 0x6F, 0x27);
  EXPECT_EQ(rig.drives[0].target(), 1000);
}

// Found in fault: configured and named, but neither reset nor enabled before rearm().
TEST(ThirdPartyDrive, FoundInFault) {
  BusRig rig(2);
  rig.drives[1].run_with(0x0218);
  ASSERT_TRUE(rig.bring_up()) << rig.fault_names();
  rig.run_ms(200);
  EXPECT_TRUE(rig.has(FaultCause::kLeftOperationEnabled, 1));
  EXPECT_EQ(rig.drives[1].num_fault_resets(), 0);
  EXPECT_FALSE(rig.bus->enable());
  ASSERT_TRUE(rig.bus->rearm());
  ASSERT_TRUE(rig.run_until(BusPhase::kReady, 1000)) << rig.fault_names();
  EXPECT_EQ(rig.drives[1].num_fault_resets(), 1);
  ASSERT_TRUE(rig.bus->enable());
  EXPECT_TRUE(rig.run_until(BusPhase::kEnabled, 500)) << rig.fault_names();
}

// An emergency about the last master's end, said while this one only listens, is about the past.
TEST(ThirdPartyDrive, EmergencyOfTheLastMaster) {
  BusRig rig(1);
  rig.build();
  rig.cycle();
  rig.bus->configure();
  rig.run_ms(100);
  rig.line.put(from_hex("081#3081110000000000"));
  ASSERT_TRUE(rig.run_until(BusPhase::kReady, 2000)) << rig.fault_names();
  EXPECT_TRUE(rig.bus->faults().empty()) << rig.fault_names();
}

}  // namespace
}  // namespace can
