// SPDX-License-Identifier: BSD-3-Clause
// The doors to other processes: frames and line records over sockets, malformed packets first.
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <vector>

#include <gtest/gtest.h>
#include <linux/can.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "bench_master.h"
#include "simulator/plant/bus_hub.h"
#include "simulator/plant/line_hub.h"
#include "simulator/plant/robot_plant.h"
#include "simulator/plant/unix_frame_server.h"
#include "tests/support/temporary_folder.h"

namespace simulator {
namespace {

/// A client's end of a socketpair; the other end belongs to the server.
struct Peer {
  Peer() {
    int ends[2] = {-1, -1};
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK, 0, ends), 0);
    mine = ends[0];
    theirs = ends[1];
  }
  ~Peer() { ::close(mine); }
  std::vector<std::vector<std::uint8_t>> read_all() const {
    std::vector<std::vector<std::uint8_t>> packets;
    std::array<std::uint8_t, 64> buffer{};
    for (ssize_t size; (size = ::recv(mine, buffer.data(), buffer.size(), 0)) > 0;) {
      packets.emplace_back(buffer.begin(), buffer.begin() + size);
    }
    return packets;
  }
  void write(const std::vector<std::uint8_t>& bytes) const {
    ASSERT_EQ(::send(mine, bytes.data(), bytes.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(bytes.size()));
  }
  int mine = -1;
  int theirs = -1;
};

std::vector<std::uint8_t> kernel_bytes(const BusFrame& frame) {
  const ::can_frame kernel = to_kernel(frame);
  std::vector<std::uint8_t> bytes(sizeof kernel);
  std::memcpy(bytes.data(), &kernel, sizeof kernel);
  return bytes;
}

// A frame becomes the kernel's sixteen bytes and comes back unchanged; a bad length is cut to 8.
TEST(BusHub, KernelFrames) {
  const BusFrame frame = frame_of(0x201, {0x0F, 0x00, 0x10, 0x27, 0x00, 0x00, 0xDC, 0x05});
  const std::vector<std::uint8_t> expected = {0x01, 0x02, 0,    0,    8,    0,    0,    0,
                                              0x0F, 0x00, 0x10, 0x27, 0x00, 0x00, 0xDC, 0x05};
  EXPECT_EQ(kernel_bytes(frame), expected);
  ::can_frame kernel = to_kernel(frame);
  EXPECT_EQ(from_kernel(kernel), frame);
  kernel.can_dlc = 200;
  EXPECT_EQ(from_kernel(kernel).length, 8);
}

// Short, long and empty packets are dropped; the plant goes on and answers the next whole one.
TEST(BusHub, PlantBehindASocket) {
  MemoryBus bus;
  RobotPlant plant({}, bus);
  auto server = std::make_unique<UnixFrameServer>("");
  Peer peer;
  server->add_client(peer.theirs);
  BusHub hub(bus, std::move(server));
  const auto exchange = [&](std::int64_t now_us) {
    hub.take_in(now_us);
    plant.advance(now_us);
    hub.give_out(now_us);
    return peer.read_all();
  };
  EXPECT_EQ(exchange(30'000).size(), 16U);  // boot-up messages
  peer.write({1, 2, 3});
  peer.write(std::vector<std::uint8_t>(40, 0xFF));
  EXPECT_TRUE(exchange(31'000).empty());
  peer.write(kernel_bytes(frame_of(0x601, {0x40, 0x00, 0x10, 0x00, 0, 0, 0, 0})));
  const auto answers = exchange(32'000);
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_EQ(answers[0],
            kernel_bytes(frame_of(0x581, {0x43, 0x00, 0x10, 0x00, 0x92, 0x01, 0x02, 0x00})));
  EXPECT_EQ(hub.num_taken(), 1);
}

// Clients that come, hear each other, and go again; a second server at the same path is refused; a
// socket file left by a dead one is replaced.
TEST(BusHub, ListensAtAPath) {
  const support::TemporaryFolder folder;
  const std::string path = folder / "can";
  std::ofstream(path) << "left over";
  UnixFrameServer server(path);
  EXPECT_THROW(UnixFrameServer second(path), DoorError);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::copy(path.begin(), path.end(), address.sun_path);
  int clients[2] = {};
  for (int& client : clients) {
    client = ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK, 0);
    ASSERT_EQ(::connect(client, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  }
  std::vector<BusFrame> frames;
  server.receive(frames);
  ASSERT_EQ(server.num_clients(), 2);  // the refused server's probe is gone again
  const ::can_frame sent = to_kernel(frame_of(0x77F, {0x05}));
  ASSERT_EQ(::send(clients[0], &sent, sizeof sent, 0), static_cast<ssize_t>(sizeof sent));
  server.receive(frames);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0], frame_of(0x77F, {0x05}));
  ::can_frame heard{};
  EXPECT_EQ(::recv(clients[1], &heard, sizeof heard, 0), static_cast<ssize_t>(sizeof heard));
  EXPECT_LT(::recv(clients[0], &heard, sizeof heard, 0), 0);
  ::close(clients[0]);
  server.receive(frames);
  EXPECT_EQ(server.num_clients(), 1);
  ::close(clients[1]);
}

// A client that never reads loses frames and holds nobody up.
TEST(BusHub, DeafClientLosesFrames) {
  UnixFrameServer server("");
  Peer peer;
  server.add_client(peer.theirs);
  for (int i = 0; i < 100'000 && server.num_lost() == 0; ++i) server.send(frame_of(0x080, {}));
  EXPECT_GT(server.num_lost(), 0);
}

// An unknown interface is refused with what to do.
TEST(BusHub, UnknownInterface) {
  EXPECT_THROW(open_gateway("nocan77"), DoorError);
}

// A new client gets all five levels, then only changes; low until the plant has spoken.
TEST(LineHub, GreetsThenTellsChanges) {
  LineHub hub("");
  Peer early;
  hub.add_client(early.theirs);
  using Records = std::vector<std::vector<std::uint8_t>>;
  EXPECT_EQ(early.read_all(), (Records{{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}}));
  hub.publish({true, false, false, false, true});
  EXPECT_EQ(early.read_all(), (Records{{0, 1}, {4, 1}}));
  hub.publish({true, false, false, false, true});
  EXPECT_TRUE(early.read_all().empty());
  Peer late;
  hub.add_client(late.theirs);
  EXPECT_EQ(late.read_all(), (Records{{0, 1}, {1, 0}, {2, 0}, {3, 0}, {4, 1}}));
}

// A tester forces and frees wires; records that mean nothing are ignored.
TEST(LineHub, TestersHand) {
  LineHub hub("");
  Peer peer;
  hub.add_client(peer.theirs);
  peer.write({5, 0});
  peer.write({4, 3});
  peer.write({4, 0, 0});
  peer.write({4, 0});
  peer.write({0, 1});
  peer.write({4, 2});
  const auto hands = hub.receive();
  ASSERT_EQ(hands.size(), 3U);
  EXPECT_EQ(hands[0].line, kEstopN);
  EXPECT_EQ(hands[0].fault, WireFault::kStuckLow);
  EXPECT_EQ(hands[1].line, kTouchFl);
  EXPECT_EQ(hands[1].fault, WireFault::kStuckHigh);
  EXPECT_EQ(hands[2].fault, WireFault::kNone);
}

// gpio-sim's pull files get the driver's words, only for what changed; a missing chip is refused.
TEST(SimulatedChip, WritesPulls) {
  const support::TemporaryFolder folder;
  EXPECT_THROW(SimulatedChip(folder.path(), {0, 1, 2, 3, 4}), DoorError);
  for (int i = 0; i < kNumLines; ++i) {
    const std::string line = folder / "sim_gpio" + std::to_string(i);
    ASSERT_EQ(std::system(("mkdir " + line + " && touch " + line + "/pull").c_str()), 0);
  }
  SimulatedChip chip(folder.path(), {4, 3, 2, 1, 0});
  const auto pull = [&](int offset) {
    std::ifstream file(folder / "sim_gpio" + std::to_string(offset) + "/pull");
    std::string word;
    file >> word;
    return word;
  };
  EXPECT_TRUE(chip.publish({true, false, false, false, true}));
  EXPECT_EQ(pull(4), "pull-up");
  EXPECT_EQ(pull(3), "pull-down");
  EXPECT_EQ(pull(0), "pull-up");
  EXPECT_TRUE(chip.publish({true, false, false, false, false}));
  EXPECT_EQ(pull(0), "pull-down");
}

}  // namespace
}  // namespace simulator
