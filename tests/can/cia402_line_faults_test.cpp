// SPDX-License-Identifier: BSD-3-Clause
// What the CiA 402 bus makes of a line that is not as it should be: broken frames, a second master,
// error frames, a full queue, a lost interface. After such a fault not one frame more.
#include <string>

#include <gtest/gtest.h>

#include "bus_rig.h"

namespace can {
namespace {

CanFrame error_frame(std::uint32_t error_class, std::uint8_t controller) {
  CanFrame frame;
  frame.id = error_class;
  frame.error = true;
  frame.dlc = 8;
  frame.data[1] = controller;
  return frame;
}

/// The bus fell silent and stays so, whatever it is asked, until rearm().
void expect_silence(BusRig& rig) {
  EXPECT_EQ(rig.bus->phase(), BusPhase::kFaulted);
  const std::size_t before = rig.line.sent.size();
  EXPECT_FALSE(rig.bus->enable());
  EXPECT_FALSE(rig.bus->stop(StopKind::kHold));
  EXPECT_FALSE(rig.bus->configure());
  rig.run_ms(500);
  EXPECT_EQ(rig.line.sent.size(), before);
}

// Whoever sends, by whatever way: a line with a fault lets nothing out until it is cleared.
TEST(Cia402LineFaults, FaultedLineSendsNothing) {
  FakeLine fake;
  FaultLog faults(4);
  BusLine line(fake, faults, nullptr, {});
  line.watch(true);
  line.begin_poll(1000);
  EXPECT_TRUE(line.send(from_hex("080#")));
  line.raise(FaultCause::kBusOff, -1, 0);
  EXPECT_FALSE(line.send(from_hex("080#")));
  EXPECT_EQ(fake.sent.size(), 1U);
  EXPECT_TRUE(line.clear());
  EXPECT_TRUE(line.send(from_hex("080#")));
  EXPECT_EQ(fake.sent.size(), 2U);
}

// Ten broken frames in a second are counted, the eleventh is a fault; eleven in two seconds are
// none.
TEST(Cia402LineFaults, MalformedFramesByRate) {
  CanFrame remote = from_hex("181#");
  remote.remote = true;
  CanFrame fd = from_hex("181#0000000000000000");
  fd.fd = true;
  const CanFrame kinds[] = {
      from_hex("181#00"), from_hex("00000181#0000000000000000"), remote, fd, from_hex("701#0000"),
      from_hex("455#00")};
  for (const CanFrame& broken : kinds) {
    BusRig rig(1);
    ASSERT_TRUE(rig.bring_to_enabled());
    for (int i = 0; i < 10; ++i) rig.line.put(broken);
    rig.cycle();
    EXPECT_TRUE(rig.bus->faults().empty()) << hex(broken);
    EXPECT_EQ(rig.bus->num_malformed(), 10U);
    rig.line.put(broken);
    rig.cycle();
    EXPECT_TRUE(rig.has(FaultCause::kMalformedFrames, -1)) << hex(broken);
    expect_silence(rig);
  }
  BusRig slow(1);
  ASSERT_TRUE(slow.bring_to_enabled());
  for (int i = 0; i < 30; ++i) {
    slow.line.put(from_hex("181#00"));
    slow.run_ms(110);
  }
  EXPECT_TRUE(slow.bus->faults().empty()) << slow.fault_names();
}

// A frame of a wrong length changes no state of its axis.
TEST(Cia402LineFaults, MalformedFramesChangeNothing) {
  BusRig rig(1);
  ASSERT_TRUE(rig.bring_to_enabled());
  rig.run_ms(20);
  const double before = rig.feedback[0].position_rad;
  rig.line.put(from_hex("181#0802FFFFFF7F00"));
  rig.cycle();
  EXPECT_EQ(rig.feedback[0].position_rad, before);
  EXPECT_EQ(rig.feedback[0].state, DriveState::kOperationEnabled);
}

// Every kind of frame that only a master sends betrays a second one; from then on: silence.
TEST(Cia402LineFaults, ForeignMaster) {
  for (const char* frame : {"000#0101", "080#", "201#0F0000000000", "210#", "27F#00", "301#00",
                            "601#4000100000000000", "67F#00", "77F#05"}) {
    BusRig rig(2);
    ASSERT_TRUE(rig.bring_to_enabled());
    rig.line.put(from_hex(frame), true);
    rig.cycle();
    ASSERT_TRUE(rig.has(FaultCause::kForeignMaster, -1)) << frame;
    EXPECT_EQ(rig.bus->faults()[0].detail, 0x80000000U | from_hex(frame).id);
    expect_silence(rig);
  }
}

// A master that is already there is heard before this one sends anything.
TEST(Cia402LineFaults, SecondControllerRefusesToStart) {
  BusRig rig(1);
  rig.build();
  rig.cycle();
  rig.bus->configure();
  rig.run_ms(250);
  rig.line.put(from_hex("77F#05"));
  rig.cycle();
  EXPECT_TRUE(rig.has(FaultCause::kForeignMaster, -1));
  expect_silence(rig);
  EXPECT_TRUE(rig.line.sent.empty());
}

// Bus-off, restart and error-passive frames silence the bus at once; error-active does not.
TEST(Cia402LineFaults, ErrorFrames) {
  struct Row {
    CanFrame frame;
    bool is_fault;
    FaultCause cause;
  };
  const Row rows[] = {{error_frame(0x40, 0), true, FaultCause::kBusOff},
                      {error_frame(0x100, 0), true, FaultCause::kBusOff},
                      {error_frame(0x04, 0x10), true, FaultCause::kErrorPassive},
                      {error_frame(0x04, 0x20), true, FaultCause::kErrorPassive},
                      {error_frame(0x01, 0), true, FaultCause::kTransmitStalled},
                      {error_frame(0x04, 0x40), false, FaultCause::kErrorPassive},
                      {error_frame(0x04, 0x08), false, FaultCause::kErrorPassive},
                      {error_frame(0x08, 0), false, FaultCause::kErrorPassive}};
  for (const Row& row : rows) {
    BusRig rig(1);
    ASSERT_TRUE(rig.bring_to_enabled());
    rig.line.put(row.frame);
    rig.cycle();
    EXPECT_EQ(rig.has(row.cause, -1), row.is_fault) << row.frame.id;
    if (row.is_fault) expect_silence(rig);
  }
}

// One cycle that does not get out is forgiven, the second in a row is a fault.
TEST(Cia402LineFaults, TransmitQueueFull) {
  for (const TransferStatus status : {TransferStatus::kNoBuffers, TransferStatus::kWouldBlock}) {
    BusRig rig(2);
    ASSERT_TRUE(rig.bring_to_enabled());
    rig.line.send_status = status;
    rig.cycle();
    rig.line.send_status = TransferStatus::kDone;
    rig.cycle();
    rig.line.send_status = status;
    rig.cycle();
    EXPECT_TRUE(rig.bus->faults().empty()) << rig.fault_names();
    rig.cycle();
    EXPECT_TRUE(rig.has(FaultCause::kTransmitStalled, -1));
    rig.line.send_status = TransferStatus::kDone;
    expect_silence(rig);
  }
}

// Frames that have not left stop the sending at once, so that none older than two cycles is behind
// them, and are purged with the fault: they must not leave when the bus comes back.
TEST(Cia402LineFaults, StaleFramesAreNeverSent) {
  BusRig rig(1);
  ASSERT_TRUE(rig.bring_to_enabled());
  rig.polls_between = false;
  rig.line.has_unsent = true;
  const std::size_t before = rig.line.sent.size();
  rig.cycle();
  EXPECT_EQ(rig.line.sent.size(), before);
  EXPECT_EQ(rig.line.num_purges, 0);
  rig.cycle();
  EXPECT_TRUE(rig.has(FaultCause::kTransmitStalled, -1));
  EXPECT_EQ(rig.line.num_purges, 1);
  EXPECT_FALSE(rig.line.has_unsent);
  expect_silence(rig);
  EXPECT_EQ(rig.line.num_purges, 1);
  rig.drives[0].position = -444;  // it sagged meanwhile
  rig.bus->rearm();
  ASSERT_TRUE(rig.run_until(BusPhase::kReady, 2000)) << rig.fault_names();
  EXPECT_EQ(rig.drives[0].target(), -444);  // from the measured position, not from the old target
}

// Also while drives are configured, when nothing is sent in cycles: a request that waits to leave
// is not followed by others, and is purged after two cycles.
TEST(Cia402LineFaults, RequestsThatWaitAreNeverSentLate) {
  BusRig rig(1);
  rig.drives[0].sdo_delay_ms = 5;
  rig.build();
  rig.cycle();
  rig.bus->configure();
  ASSERT_TRUE(rig.run_until(BusPhase::kConfiguring, 1000));
  rig.run_ms(20);
  const std::size_t before = rig.line.sent.size();
  rig.line.has_unsent = true;
  rig.run_ms(30);
  EXPECT_TRUE(rig.has(FaultCause::kTransmitStalled, -1));
  EXPECT_EQ(rig.line.num_purges, 1);
  EXPECT_LE(rig.line.sent.size(), before + 1);  // a heartbeat
}

// Where nothing could be purged, nothing is sent again before it can.
TEST(Cia402LineFaults, WithoutPurgeNothingIsSent) {
  BusRig rig(1);
  ASSERT_TRUE(rig.bring_to_enabled());
  rig.line.has_unsent = true;
  rig.line.purge_result = PurgeResult::kNotPermitted;
  rig.run_ms(20);
  EXPECT_TRUE(rig.has(FaultCause::kTransmitStalled, -1));
  rig.bus->rearm();
  rig.run_ms(20);
  EXPECT_TRUE(rig.has(FaultCause::kTransmitStalled, -1));
  expect_silence(rig);
  EXPECT_EQ(rig.line.num_purges, 2);
  rig.line.purge_result = PurgeResult::kPurged;
  rig.bus->rearm();
  EXPECT_TRUE(rig.run_until(BusPhase::kReady, 2000)) << rig.fault_names();
}

// A lost interface silences the bus; when it is back, nothing happens before rearm().
TEST(Cia402LineFaults, InterfaceLostAndBack) {
  for (const TransferStatus status : {TransferStatus::kNetworkDown, TransferStatus::kGone}) {
    BusRig rig(1);
    ASSERT_TRUE(rig.bring_to_enabled());
    rig.line.receive_status = status;
    rig.line.send_status = status;
    rig.line.is_usable = false;
    rig.cycle();
    EXPECT_TRUE(rig.has(FaultCause::kInterfaceLost, -1));
    rig.bus->rearm();
    rig.run_ms(20);
    expect_silence(rig);
    rig.line.receive_status = TransferStatus::kWouldBlock;
    rig.line.send_status = TransferStatus::kDone;
    rig.line.is_usable = true;
    expect_silence(rig);
    rig.bus->rearm();
    EXPECT_TRUE(rig.run_until(BusPhase::kReady, 2000)) << rig.fault_names();
  }
}

// After a fault of the bus, re-arming listens again before it speaks.
TEST(Cia402LineFaults, RearmListensAgain) {
  BusRig rig(1);
  ASSERT_TRUE(rig.bring_to_enabled());
  rig.line.put(error_frame(0x40, 0));
  rig.cycle();
  const std::size_t before = rig.line.sent.size();
  rig.bus->rearm();
  rig.run_ms(280);
  EXPECT_EQ(rig.line.sent.size(), before);
  EXPECT_TRUE(rig.run_until(BusPhase::kReady, 500));
}

}  // namespace
}  // namespace can
