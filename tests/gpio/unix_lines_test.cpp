// SPDX-License-Identifier: BSD-3-Clause
// The line hub's client against a hub of the test's own hand (odd packets), and against the hub of
// the simulated robot.
#include "gpio/unix_lines.h"

#include <atomic>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "gpio/lines.h"
#include "simulator/plant/line_hub.h"
#include "tests/support/temporary_folder.h"

namespace gpio {
namespace {

using testing::HasSubstr;
using Packet = std::vector<std::uint8_t>;

/// The hub's end of a socketpair.
struct HandHub {
  HandHub() {
    int ends[2] = {-1, -1};
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK, 0, ends), 0);
    hub = ends[0];
    client = ends[1];
  }
  ~HandHub() { hang_up(); }
  HandHub(const HandHub&) = delete;
  HandHub& operator=(const HandHub&) = delete;

  void hang_up() {
    if (hub >= 0) ::close(hub);
    hub = -1;
  }
  bool send(const Packet& packet) const {
    return ::send(hub, packet.data(), packet.size(), MSG_NOSIGNAL | MSG_DONTWAIT) ==
           static_cast<ssize_t>(packet.size());
  }
  void greet() const {
    for (std::uint8_t line = 0; line < kNumLines; ++line) send({line, line == kEstop});
  }
  int hub = -1;
  int client = -1;  ///< belongs to the UnixLines made of it
};

// Packets of every wrong form, at the beginning or later, lose the chip: who says nonsense is not
// believed about the E-stop either.
TEST(UnixLines, NonsenseIsALoss) {
  const std::vector<Packet> nonsense = {{4},      {4, 1, 0}, Packet(64, 1), {5, 1},
                                        {255, 0}, {4, 2},    {4, 255}};
  for (const Packet& packet : nonsense) {
    for (const bool greeted : {false, true}) {
      HandHub hub;
      UnixLines lines(hub.client);
      Levels levels{};
      if (greeted) {
        hub.greet();
        ASSERT_EQ(lines.read(levels), ReadStatus::kDone);
      }
      ASSERT_TRUE(hub.send(packet));
      EXPECT_EQ(lines.read(levels), ReadStatus::kLost);
      EXPECT_THAT(lines.loss(), HasSubstr("is not {line 0..4, level 0 or 1}"));
      EXPECT_EQ(lines.wake_fd(), -1);
      EXPECT_EQ(lines.read(levels), ReadStatus::kLost);
    }
  }
}

// No level is known before all five have been told, in whatever order.
TEST(UnixLines, AllFiveOrNone) {
  HandHub hub;
  UnixLines lines(hub.client);
  EXPECT_EQ(lines.open(), "");
  Levels levels{};
  EXPECT_EQ(lines.read(levels), ReadStatus::kPending);
  for (const std::uint8_t line : Packet{4, 2, 2, 0, 3}) {
    hub.send({line, 1});
    EXPECT_EQ(lines.read(levels), ReadStatus::kPending);
  }
  hub.send({1, 0});
  EXPECT_EQ(lines.read(levels), ReadStatus::kDone);
  EXPECT_EQ(levels, (Levels{true, false, true, true, true}));
}

// A hub that hangs up is a loss, even if it greeted and went before we looked.
TEST(UnixLines, HangsUp) {
  HandHub hub;
  UnixLines lines(hub.client);
  hub.greet();
  hub.hang_up();
  Levels levels{};
  EXPECT_EQ(lines.read(levels), ReadStatus::kLost);
  EXPECT_THAT(lines.loss(), HasSubstr("has gone"));
  EXPECT_THAT(lines.open(), HasSubstr("cannot be opened again"));
}

// As many changes as the socket holds are read in one go, and the last of them counts.
TEST(UnixLines, AFullSocketIsReadAtOnce) {
  HandHub hub;
  UnixLines lines(hub.client);
  hub.greet();
  int num_sent = 0;
  while (hub.send({kEstop, static_cast<std::uint8_t>(num_sent % 2)})) ++num_sent;
  ASSERT_GT(num_sent, 100);
  Levels levels{};
  EXPECT_EQ(lines.read(levels), ReadStatus::kDone);
  EXPECT_EQ(levels[kEstop], (num_sent - 1) % 2 == 1);
}

// A hub that never stops talking cannot hold us: every reading ends, with the chip lost or with
// levels, and once it is silent the last level stands.
TEST(UnixLines, AFloodEnds) {
  HandHub hub;
  UnixLines lines(hub.client);
  hub.greet();
  std::atomic<bool> stop = false;
  std::thread flood([&] {
    for (std::uint8_t level = 0; !stop; level = 1 - level) hub.send({kEstop, level});
  });
  Levels levels{};
  ReadStatus status = ReadStatus::kDone;
  for (int i = 0; i < 500 && status == ReadStatus::kDone; ++i) status = lines.read(levels);
  stop = true;
  flood.join();
  if (status == ReadStatus::kLost) {
    EXPECT_THAT(lines.loss(), HasSubstr("floods"));
  } else {
    lines.read(levels);
    ASSERT_TRUE(hub.send({kEstop, 0}));
    EXPECT_EQ(lines.read(levels), ReadStatus::kDone);
    EXPECT_FALSE(levels[kEstop]);
  }
}

// No hub, a path that is a file, one that is too long: told, not thrown.
TEST(UnixLines, NoHub) {
  const support::TemporaryFolder folder;
  EXPECT_THAT(UnixLines(folder / "lines").open(), HasSubstr("no line hub listens at"));
  EXPECT_THAT(UnixLines("/dev/null").open(), HasSubstr("no line hub listens at /dev/null"));
  EXPECT_THAT(UnixLines(std::string(200, 'x')).open(), HasSubstr("too long"));
}

simulator::LineLevels at_rest() {
  simulator::LineLevels levels{};
  levels[simulator::kEstopN] = true;
  return levels;
}

/// The simulated robot's hub and our lines, through a socket file, in virtual time.
struct HubTest : testing::Test {
  HubTest() { params.chip = "unix:" + path; }
  void start_hub() {
    hub.emplace(path);
    hub->publish(at_rest());
  }
  /// One cycle of 10 ms.
  const LineStates& cycle(Lines& lines) {
    now_us += 10'000;
    if (hub) hub->receive();
    return lines.poll(now_us);
  }
  support::TemporaryFolder folder;
  std::string path = folder / "lines";
  LinesParams params;
  std::optional<simulator::LineHub> hub;
  std::int64_t now_us = 0;
};

// Each of the hub's lines is the one of ours that has its name.
TEST_F(HubTest, LinesAreTheSame) {
  start_hub();
  const std::unique_ptr<LineChip> chip = make_line_chip(params);
  Lines lines(params, *chip);
  cycle(lines);
  EXPECT_EQ(cycle(lines), (LineStates{{}, false, false}));
  for (int leg = 0; leg < kNumTouch; ++leg) {
    ASSERT_EQ(params.touch[leg].name, simulator::kLineNames[leg]);
    simulator::LineLevels levels = at_rest();
    levels[leg] = true;
    hub->publish(levels);
    LineStates expected{{}, false, false};
    expected.touch[leg] = true;
    EXPECT_EQ(cycle(lines), expected);
  }
  ASSERT_EQ(params.estop.name, simulator::kLineNames[simulator::kEstopN]);
  hub->publish({});
  EXPECT_FALSE(cycle(lines).estop_active);
  EXPECT_TRUE(cycle(lines).estop_active) << "second reading, 10 ms on";
}

// A hub that was not there at first, dies, and comes back at the same path.
TEST_F(HubTest, DiesAndComesBack) {
  const std::unique_ptr<LineChip> chip = make_line_chip(params);
  Lines lines(params, *chip);
  EXPECT_THAT(lines.open(), HasSubstr("no line hub listens at " + path));
  for (int round = 0; round < 3; ++round) {
    start_hub();
    int num_cycles = 0;
    while (cycle(lines).lost) ASSERT_LT(++num_cycles, 100) << "found within 1 s";
    EXPECT_FALSE(lines.states().estop_active);
    hub.reset();
    EXPECT_EQ(cycle(lines), LineStates{}) << "a stop in the cycle of the loss";
    for (int i = 0; i < 20; ++i) EXPECT_EQ(cycle(lines), LineStates{});
  }
  EXPECT_EQ(lines.num_losses(), 3);
}

// At the start, open() waits for a hub that is slow to greet, and gives up on one that never does.
TEST_F(HubTest, OpenWaitsForTheGreeting) {
  start_hub();
  {
    const std::unique_ptr<LineChip> chip = make_line_chip(params);
    Lines lines(params, *chip);
    EXPECT_THAT(lines.open(20), HasSubstr("tells no levels"));
    EXPECT_TRUE(lines.states().estop_active);
  }
  const std::unique_ptr<LineChip> chip = make_line_chip(params);
  Lines lines(params, *chip);
  std::atomic<bool> opened = false;
  std::thread plant([&] {
    while (!opened) {
      hub->receive();
      std::this_thread::yield();
    }
  });
  EXPECT_EQ(lines.open(30'000), "");
  opened = true;
  plant.join();
  EXPECT_FALSE(lines.poll(0).estop_active);
}

}  // namespace
}  // namespace gpio
