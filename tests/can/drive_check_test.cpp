// SPDX-License-Identifier: BSD-3-Clause
// The drive check against scripted drives in virtual time: the verdict, what is named, and that no
// torque is switched on unless a move was asked for.
#include "climb_controller/drive_check.h"

#include <set>

#include <gtest/gtest.h>

#include "fake_line.h"
#include "scripted_drive.h"

namespace climb_controller {
namespace {

using can::FakeLine;
using can::ScriptedDrive;

class Desk {
 public:
  Desk() {
    params.axis.node_id = 2;
    params.axis.counts_per_rad = 1000.0;
    drive.set_object(0x6064, 0, 250);
    drive.position = 250;
  }

  DriveReport run(int limit_ms = 60'000) {
    EXPECT_EQ(check(params), "");
    DriveCheck checked(params, line);
    for (int ms = 0; ms < limit_ms && !checked.is_done(); ++ms) {
      const std::int64_t now_us = 1'000'000 + 1000 * ms;
      ms % 10 == 0 ? checked.cycle(now_us) : checked.poll(now_us);
      if (ms == cancel_at_ms) checked.cancel();
      for (; num_delivered_ < line.sent.size(); ++num_delivered_) {
        for (const auto& answer : drive.hear(line.sent[num_delivered_])) line.put(answer);
      }
      for (const auto& frame : drive.tick(ms)) line.put(frame);
      if (neighbour_speaks && ms % 5 == 0) line.put(can::from_hex("707#05"));
      states.insert(drive.status_word() & 0x6F);
      if (drive.position > farthest) farthest = drive.position;
    }
    EXPECT_TRUE(checked.is_done());
    text = text_of(checked.report(), params);
    return checked.report();
  }

  DriveCheckParams params;
  FakeLine line;
  ScriptedDrive drive{2};
  std::set<int> states;
  std::int32_t farthest = INT32_MIN;
  int cancel_at_ms = -1;
  bool neighbour_speaks = false;
  std::string text;

 private:
  std::size_t num_delivered_ = 0;
};

// A whole drive passes; without a move it never leaves "switch on disabled".
TEST(DriveCheck, WholeDrivePassesWithoutTorque) {
  Desk desk;
  const DriveReport report = desk.run();
  EXPECT_EQ(report.verdict, DriveVerdict::kFit) << desk.text;
  EXPECT_EQ(report.start_rad, 0.25);
  EXPECT_EQ(desk.states, std::set<int>{0x40});
  EXPECT_NE(desk.text.find("PASS: fit for climbing"), std::string::npos);
}

// The move goes there and back, starts where the drive stands, and ends without torque.
TEST(DriveCheck, MovesThereAndBack) {
  Desk desk;
  desk.params.move_rad = 0.05;
  const DriveReport report = desk.run();
  EXPECT_EQ(report.verdict, DriveVerdict::kFit) << desk.text;
  EXPECT_EQ(desk.drive.first_enabled_target(), 250);
  EXPECT_EQ(desk.farthest, 300);
  EXPECT_EQ(desk.drive.position, 250);
  EXPECT_EQ(desk.drive.status_word() & 0x6F, 0x40);
  // Soft limits lie round the place where it stands, not round zero.
  EXPECT_EQ(static_cast<std::int32_t>(desk.drive.object(0x607D, 1)), -250);
  EXPECT_EQ(static_cast<std::int32_t>(desk.drive.object(0x607D, 2)), 800);
}

// Missing 6007h, 6072h, 6077h: good for the ground, each named.
TEST(DriveCheck, SmallDriveIsForTheGround) {
  Desk desk;
  desk.params.move_rad = 0.05;
  for (const int index : {0x6007, 0x6072, 0x6077}) {
    desk.drive.lack(static_cast<std::uint16_t>(index));
  }
  const DriveReport report = desk.run();
  EXPECT_EQ(report.verdict, DriveVerdict::kGroundOnly) << desk.text;
  for (const char* object : {"6007h:0 abort connection", "6072h:0 max torque", "6077h:0 torque"}) {
    EXPECT_NE(desk.text.find(object), std::string::npos) << desk.text;
  }
  EXPECT_EQ(desk.drive.num_wrong_lengths(), 0);
  EXPECT_EQ(desk.farthest, 300);
}

// Each thing that can be wrong, in words.
TEST(DriveCheck, SaysWhatIsWrong) {
  const auto problem_after = [](auto harm) {
    Desk desk;
    desk.params.move_rad = 0.1;
    harm(desk);
    const DriveReport report = desk.run();
    EXPECT_EQ(report.verdict, DriveVerdict::kUnfit) << desk.text;
    return report.problem;
  };
  EXPECT_EQ(problem_after([](Desk& desk) { desk.drive.is_silent = true; }),
            "no answer from this node");
  EXPECT_EQ(problem_after([](Desk& desk) { desk.drive.lack(0x6064); }),
            "6064h position cannot be read");
  EXPECT_EQ(problem_after([](Desk& desk) { desk.drive.lack(0x6060); }), "it cannot be configured");
  EXPECT_EQ(problem_after([](Desk& desk) { desk.drive.fail(); }), "found in fault");
  EXPECT_EQ(problem_after([](Desk& desk) { desk.drive.ignores_control_word = true; }),
            "it does not enable");
  EXPECT_EQ(problem_after([](Desk& desk) { desk.line.is_usable = false; }),
            "the CAN line is not usable");
  EXPECT_EQ(problem_after([](Desk& desk) { desk.line.put(can::from_hex("77F#05")); }),
            "another master speaks: frame 77Fh");
  EXPECT_EQ(problem_after([](Desk& desk) { desk.drive.is_stuck = true; }),
            "it did not follow its target");
}

// A fault is reset only where that was asked for.
TEST(DriveCheck, ResetsAFaultWhenAsked) {
  Desk desk;
  desk.drive.fail();
  desk.params.reset_fault = true;
  EXPECT_EQ(desk.run().verdict, DriveVerdict::kFit) << desk.text;
  EXPECT_EQ(desk.drive.num_fault_resets(), 1);
}

// Other drives on the bus may speak, and nothing is sent to them.
TEST(DriveCheck, LeavesTheNeighboursAlone) {
  Desk desk;
  desk.neighbour_speaks = true;
  EXPECT_EQ(desk.run().verdict, DriveVerdict::kFit) << desk.text;
  for (const can::CanFrame& frame : desk.line.sent) {
    const bool is_for_all = frame.id == 0x080 || frame.id == 0x77F;
    const bool is_nmt = frame.id == 0x000 && frame.data[1] == 2;
    EXPECT_TRUE(is_for_all || is_nmt || (frame.id & 0x7F) == 2) << can::hex(frame);
  }
}

// Cancelled in the middle of a move: torque is walked down before the end.
TEST(DriveCheck, CancelledInTheMiddle) {
  Desk desk;
  desk.params.move_rad = 0.4;
  desk.cancel_at_ms = 3000;
  const DriveReport report = desk.run();
  EXPECT_EQ(report.problem, "cancelled");
  EXPECT_GT(desk.states.count(0x27), 0U);
  EXPECT_EQ(desk.drive.status_word() & 0x6F, 0x40);
}

// Parameters that make no sense are named.
TEST(DriveCheck, ChecksItsParameters) {
  DriveCheckParams params;
  EXPECT_EQ(check(params), "node_id in 1..126");
  params.axis.node_id = 1;
  EXPECT_EQ(check(params), "");
  params.move_rad = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(check(params), "move_rad in -3.2..3.2");
  params.move_rad = 0.0;
  params.speed_rad_s = 0.0;
  EXPECT_EQ(check(params), "0 < speed_rad_s <= max_velocity_rad_s");
}

}  // namespace
}  // namespace climb_controller
