// SPDX-License-Identifier: BSD-3-Clause
// The CiA 402 bus in real time against a slave that this project did not write: npm's canopen
// behind a unix: line. Skipped, by name and with the reason, where Node or its packages are
// missing.
#include <chrono>
#include <cmath>
#include <ctime>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "can/can_socket.h"
#include "can/cia402_bus.h"
#include "tests/support/child_process.h"
#include "tests/support/temporary_folder.h"

namespace can {
namespace {

using std::chrono::milliseconds;

const std::string kFolder = std::string(LADDER_SOURCE_DIR) + "/scripts/canopen_peer";

std::int64_t now_us() {
  timespec time{};
  ::clock_gettime(CLOCK_MONOTONIC, &time);
  return std::int64_t{time.tv_sec} * 1'000'000 + time.tv_nsec / 1000;
}

/// "" or why the slave cannot run here.
std::string why_not() {
  support::ChildProcess prepare(kFolder + "/prepare", {});
  const auto status = prepare.wait(std::chrono::seconds(60));
  if (status == 0) return "";
  return "SKIPPED canopen_peer_test: " + prepare.output();
}

class CanopenPeer : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string reason = why_not();
    if (!reason.empty()) GTEST_SKIP() << reason;
  }

  void TearDown() override {
    bus.reset();
    bridge_.reset();
  }

  /// The slave on its line, which is there afterwards.
  void start_line(const std::vector<std::string>& missing) {
    std::vector<std::string> arguments = {kFolder + "/bridge.py", "unix:" + path_, "node",
                                          kFolder + "/slave.js", "1"};
    arguments.insert(arguments.end(), missing.begin(), missing.end());
    bridge_ = std::make_unique<support::ChildProcess>("/usr/bin/python3", arguments);
    for (int i = 0; i < 100 && ::access(path_.c_str(), F_OK) != 0; ++i) {
      std::this_thread::sleep_for(milliseconds(50));
    }
  }

  void start(const Cia402Params& params, const std::vector<std::string>& missing = {}) {
    start_line(missing);
    socket_ = std::make_unique<CanSocket>(CanSocketParams{"unix:" + path_});
    for (int i = 0; i < 100 && !socket_->open().empty(); ++i) {
      std::this_thread::sleep_for(milliseconds(50));
    }
    ASSERT_GE(socket_->fd(), 0) << bridge_->output();
    bus = std::make_unique<Cia402Bus>(params, *socket_, &recorder);
    run_ms(500);  // the slave's interpreter starts
  }

  const std::string& path() const { return path_; }

  void run_ms(int duration_ms) {
    const std::int64_t end_us = now_us() + duration_ms * 1000;
    while (now_us() < end_us) {
      const std::int64_t time_us = now_us();
      bus->exchange(time_us, {time_us, {&target, 1}}, {&feedback, 1});
      while (now_us() < time_us + 10'000) {
        std::this_thread::sleep_for(milliseconds(1));
        bus->poll(now_us());
      }
    }
  }

  bool run_until(BusPhase phase, int limit_ms) {
    for (int i = 0; i < limit_ms / 20 && bus->phase() != phase; ++i) run_ms(20);
    return bus->phase() == phase;
  }

  /// What went wrong, with the log's end.
  std::string story() const {
    std::ostringstream text;
    for (const ObjectIssue& issue : bus->issues()) text << describe(issue) << '\n';
    for (const Fault& fault : bus->faults()) {
      text << name(fault.cause) << ' ' << fault.axis << ' ' << fault.detail << '\n';
    }
    recorder.write_events(text);
    return text.str() + bridge_->output();
  }

  /// One axis; patient, since an interpreter answers on a loaded machine.
  static Cia402Params patient_params() {
    Cia402Params params;
    AxisConfig axis;
    axis.node_id = 1;
    axis.counts_per_rad = 1000.0;
    params.axes = {axis};
    params.max_missed_cycles = 20;
    params.drive_lost_ms = 1000;
    params.line.max_stalled_cycles = 20;
    return params;
  }

  CanSocket& socket() { return *socket_; }

  FlightRecorder recorder;
  std::unique_ptr<Cia402Bus> bus;
  AxisTarget target;
  AxisFeedback feedback;

 private:
  support::TemporaryFolder folder_;
  std::string path_ = folder_ / "line";
  std::unique_ptr<support::ChildProcess> bridge_;
  std::unique_ptr<CanSocket> socket_;
};

// NMT, heartbeat, SDO write and read-back, RPDO, SYNC, TPDO: from power-up to a target and back.
TEST_F(CanopenPeer, WholeCycle) {
  start(patient_params());
  ASSERT_TRUE(bus->configure());
  ASSERT_TRUE(run_until(BusPhase::kReady, 8000)) << story();
  EXPECT_TRUE(bus->issues().empty()) << story();
  EXPECT_TRUE(bus->capabilities().hold_on_loss);
  ASSERT_TRUE(bus->enable());
  target.position_rad = 1.0;  // where it stands
  ASSERT_TRUE(run_until(BusPhase::kEnabled, 3000)) << story();
  EXPECT_EQ(feedback.position_rad, 1.0);
  target.position_rad = 1.5;
  run_ms(300);
  EXPECT_EQ(feedback.position_rad, 1.5) << story();
  EXPECT_EQ(feedback.torque_Nm, 2.0);
  EXPECT_EQ(feedback.state, DriveState::kOperationEnabled);
  ASSERT_TRUE(bus->stop(StopKind::kQuickStop));
  run_ms(200);
  EXPECT_EQ(feedback.state, DriveState::kQuickStopActive) << story();
  ASSERT_TRUE(bus->disable());
  ASSERT_TRUE(run_until(BusPhase::kReady, 3000)) << story();
  EXPECT_EQ(feedback.state, DriveState::kSwitchOnDisabled);
  EXPECT_TRUE(bus->faults().empty()) << story();
}

// The slave's own heartbeat consumer (1016h) notices that the master is gone, and it holds.
TEST_F(CanopenPeer, HoldsWhenTheMasterIsGone) {
  start(patient_params());
  bus->configure();
  ASSERT_TRUE(run_until(BusPhase::kReady, 8000)) << story();
  target.position_rad = 1.0;
  bus->enable();
  ASSERT_TRUE(run_until(BusPhase::kEnabled, 3000)) << story();
  run_ms(100);
  std::this_thread::sleep_for(milliseconds(600));  // nobody feeds the heartbeat
  run_ms(100);
  EXPECT_NE(feedback.state, DriveState::kSwitchOnDisabled);
  bool noticed = false;
  for (const Fault& fault : bus->faults()) {
    noticed = noticed || fault.cause == FaultCause::kLeftOperationEnabled;
  }
  EXPECT_TRUE(noticed) << story();
}

// A slave without 6007h comes up without the capability, the object named.
TEST_F(CanopenPeer, MissingAbortConnectionIsNamed) {
  start(patient_params(), {"6007"});
  bus->configure();
  ASSERT_TRUE(run_until(BusPhase::kReady, 8000)) << story();
  EXPECT_FALSE(bus->capabilities().hold_on_loss);
  ASSERT_EQ(bus->issues().size(), 1U);
  EXPECT_EQ(describe(bus->issues()[0]),
            "axis 0: 6007h:0 abort connection option code: object does not exist (abort "
            "06020000h)");
}

// A slave without 6007h, 6072h and 6077h: no climbing with it, since neither capability is claimed
// and each object is named; on the ground it follows by the 6-byte frames, without one emergency
// about a frame's length.
TEST_F(CanopenPeer, WithoutTorqueObjects) {
  start(patient_params(), {"6007", "6072", "6077"});
  bus->configure();
  ASSERT_TRUE(run_until(BusPhase::kReady, 12'000)) << story();
  EXPECT_FALSE(bus->capabilities().hold_on_loss);
  EXPECT_FALSE(bus->capabilities().torque_limit);
  std::string named;
  for (const ObjectIssue& issue : bus->issues()) named += describe(issue).substr(8, 6) + " ";
  EXPECT_EQ(named, "6072h: 6077h: 6007h: ") << story();
  target.position_rad = 1.0;
  bus->enable();
  ASSERT_TRUE(run_until(BusPhase::kEnabled, 3000)) << story();
  target.position_rad = 1.3;
  run_ms(300);
  EXPECT_EQ(feedback.position_rad, 1.3) << story();
  EXPECT_TRUE(std::isnan(feedback.torque_Nm));
  EXPECT_TRUE(bus->faults().empty()) << story();
}

// That slave does complain about a frame that is longer than its mapping: the test above can fail.
TEST_F(CanopenPeer, WrongLengthIsAnEmergency) {
  start(patient_params(), {"6007", "6072", "6077"});
  bus->configure();
  ASSERT_TRUE(run_until(BusPhase::kReady, 12'000)) << story();
  ASSERT_EQ(socket().send(cia402::encode(cia402::Rpdo1{1, 0, 0, std::uint16_t{100}})),
            TransferStatus::kDone);
  run_ms(200);
  ASSERT_FALSE(bus->faults().empty());
  EXPECT_EQ(bus->faults()[0].cause, FaultCause::kEmergency) << story();
  EXPECT_EQ(bus->faults()[0].detail, 0x8220U);
}

// The user's tool says the same of it, with its exit code: not for climbing, good for the ground.
TEST_F(CanopenPeer, DriveCheckTool) {
  start_line({"6007", "6072", "6077"});
  std::this_thread::sleep_for(milliseconds(500));  // the slave's interpreter starts
  support::ChildProcess tool(LADDER_DRIVE_CHECK, {"--can", "unix:" + path(), "--node", "1",
                                                  "--counts-per-rad", "1000", "--move-rad", "0.2"});
  EXPECT_EQ(tool.wait(std::chrono::seconds(60)), 3) << tool.output();
  EXPECT_NE(tool.output().find("GROUND TESTS ONLY"), std::string::npos) << tool.output();
  EXPECT_NE(tool.output().find("6007h:0 abort connection option code"), std::string::npos);
}

}  // namespace
}  // namespace can
