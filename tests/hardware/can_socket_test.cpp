// SPDX-License-Identifier: BSD-3-Clause
// The socket door on the kernel's own raw CAN: what crosses, what an interface says when it goes,
// how it is found again, and that no frame leaves late.
#include "can/can_socket.h"

#include <array>
#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "tests/hardware/can_interface.h"

namespace {

using can::CanFrame;
using can::CanSocket;
using can::CanSocketParams;
using can::PurgeResult;
using can::ReceivedFrame;
using can::TransferStatus;
using hardware::BareSocket;
using hardware::kernel_frame;
using hardware::VirtualCan;

CanFrame sync_frame() {
  CanFrame frame;
  frame.id = 0x080;
  return frame;
}

/// The next frame of a non-blocking socket, waited for up to two seconds.
TransferStatus receive(CanSocket& socket, ReceivedFrame& received) {
  TransferStatus status = TransferStatus::kWouldBlock;
  for (int i = 0; i < 2000 && status == TransferStatus::kWouldBlock; ++i) {
    status = socket.receive(received);
    if (status == TransferStatus::kWouldBlock) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  return status;
}

// A frame crosses in both directions byte for byte, with the kernel's time of receipt.
TEST(CanSocketOnKernel, FrameCrosses) {
  const VirtualCan line("lt0");
  CanSocket socket(CanSocketParams{line.name()});
  ASSERT_EQ(socket.open(), "");
  BareSocket peer(line.name());
  CanFrame frame;
  frame.id = 0x201;
  frame.dlc = 8;
  frame.data = {1, 2, 3, 4, 5, 6, 7, 0xFF};
  ASSERT_EQ(socket.send(frame), TransferStatus::kDone);
  const auto at_peer = peer.receive();
  ASSERT_TRUE(at_peer);
  EXPECT_EQ(at_peer->can_id, 0x201U);
  EXPECT_EQ(at_peer->data[7], 0xFF);

  ASSERT_TRUE(peer.send(kernel_frame(0x181, "servo")));
  ReceivedFrame received;
  ASSERT_EQ(receive(socket, received), TransferStatus::kDone);
  EXPECT_EQ(received.frame.id, 0x181U);
  EXPECT_EQ(received.frame.dlc, 5);
  EXPECT_EQ(received.frame.data[4], 'o');
  EXPECT_TRUE(can::is_plain(received.frame));
  EXPECT_GT(received.receive_us, 1'500'000'000'000'000);  // after 2017
  // Its own frames do not come back.
  EXPECT_EQ(socket.receive(received), TransferStatus::kWouldBlock);
}

// Remote, 29-bit and FD frames are seen for what they are; the kernel itself refuses a wrong
// length.
TEST(CanSocketOnKernel, OddFramesAreMarked) {
  const VirtualCan line("lt0");
  CanSocket socket(CanSocketParams{line.name()});
  ASSERT_EQ(socket.open(), "");
  BareSocket peer(line.name());
  ReceivedFrame received;
  ASSERT_TRUE(peer.send(kernel_frame(0x181 | CAN_RTR_FLAG)));
  ASSERT_EQ(receive(socket, received), TransferStatus::kDone);
  EXPECT_TRUE(received.frame.remote);
  ASSERT_TRUE(peer.send(kernel_frame(0x181 | CAN_EFF_FLAG)));
  ASSERT_EQ(receive(socket, received), TransferStatus::kDone);
  EXPECT_TRUE(received.frame.extended);
  canfd_frame fd{};
  fd.can_id = 0x181;
  for (const int length : {0, 8, 12, 64}) {
    fd.len = static_cast<__u8>(length);
    ASSERT_TRUE(peer.send(fd));
    ASSERT_EQ(receive(socket, received), TransferStatus::kDone);
    EXPECT_TRUE(received.frame.fd) << length;
    EXPECT_LE(received.frame.dlc, 8);
  }
  ::can_frame too_long = kernel_frame(0x181, "12345678");
  too_long.can_dlc = 9;
  EXPECT_FALSE(peer.send(too_long));
  EXPECT_EQ(socket.receive(received), TransferStatus::kWouldBlock);
}

// Error frames of the controller's driver arrive, with their class and bytes.
TEST(CanSocketOnKernel, ErrorFramesArrive) {
  const VirtualCan line("lt0");
  CanSocket socket(CanSocketParams{line.name()});
  ASSERT_EQ(socket.open(), "");
  BareSocket driver(line.name());
  ASSERT_TRUE(driver.send(kernel_frame(CAN_ERR_FLAG | CAN_ERR_BUSOFF, std::string(8, '\0'))));
  ReceivedFrame received;
  ASSERT_EQ(receive(socket, received), TransferStatus::kDone);
  EXPECT_TRUE(received.frame.error);
  EXPECT_EQ(received.frame.id, static_cast<std::uint32_t>(CAN_ERR_BUSOFF));
  std::string passive(8, '\0');
  passive[1] = CAN_ERR_CRTL_TX_PASSIVE;
  ASSERT_TRUE(driver.send(kernel_frame(CAN_ERR_FLAG | CAN_ERR_CRTL, passive)));
  ASSERT_EQ(receive(socket, received), TransferStatus::kDone);
  EXPECT_EQ(received.frame.data[1], CAN_ERR_CRTL_TX_PASSIVE);
}

// An interface taken down is said once by the kernel and latched here; up again it is re-opened.
TEST(CanSocketOnKernel, DownAndUp) {
  VirtualCan line("lt0");
  CanSocket socket(CanSocketParams{line.name()});
  ASSERT_TRUE(socket.maintain(0));
  line.down();
  EXPECT_EQ(socket.send(sync_frame()), TransferStatus::kNetworkDown);
  ReceivedFrame received;
  for (int i = 0; i < 3; ++i) EXPECT_EQ(socket.receive(received), TransferStatus::kNetworkDown);
  EXPECT_FALSE(socket.maintain(0));
  EXPECT_NE(socket.open().find("ip link set lt0 up"), std::string::npos);
  line.up();
  EXPECT_FALSE(socket.maintain(10'000));  // the first pause is 50 ms
  EXPECT_TRUE(socket.maintain(50'000));
  EXPECT_EQ(socket.send(sync_frame()), TransferStatus::kDone);
}

// Receiving alone notices as well that the interface went down.
TEST(CanSocketOnKernel, DownSeenByReceiving) {
  VirtualCan line("lt0");
  CanSocket socket(CanSocketParams{line.name()});
  ASSERT_TRUE(socket.maintain(0));
  line.down();
  ReceivedFrame received;
  EXPECT_EQ(receive(socket, received), TransferStatus::kNetworkDown);
  EXPECT_FALSE(socket.maintain(0));
}

// A deleted interface is gone; its successor of the same name, with another index, is found.
TEST(CanSocketOnKernel, DeletedAndMadeAgain) {
  VirtualCan line("lt0");
  CanSocket socket(CanSocketParams{line.name()});
  ASSERT_TRUE(socket.maintain(0));
  const unsigned old_index = ::if_nametoindex("lt0");
  line.remove();
  ReceivedFrame received;
  const TransferStatus status = receive(socket, received);
  EXPECT_TRUE(status == TransferStatus::kGone || status == TransferStatus::kNetworkDown)
      << can::name(status);
  EXPECT_FALSE(socket.maintain(0));
  EXPECT_NE(socket.open(), "");
  const VirtualCan other("lt1");  // takes an index, so that the name cannot get its old one
  line.create();
  EXPECT_NE(::if_nametoindex("lt0"), old_index);
  EXPECT_TRUE(socket.maintain(1'000'000));
  BareSocket peer(line.name());
  EXPECT_EQ(socket.send(sync_frame()), TransferStatus::kDone);
  EXPECT_TRUE(peer.receive());
}

// Twenty times down and up: each time lost, each time found, and frames cross again.
TEST(CanSocketOnKernel, DownAndUpManyTimes) {
  VirtualCan line("lt0");
  CanSocket socket(CanSocketParams{line.name()});
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(socket.maintain(i * 1'000'000)) << i;
    EXPECT_EQ(socket.send(sync_frame()), TransferStatus::kDone);
    if (i % 2 == 0) {
      line.down();
      EXPECT_EQ(socket.send(sync_frame()), TransferStatus::kNetworkDown);
      line.up();
    } else {
      line.remove();
      EXPECT_NE(socket.send(sync_frame()), TransferStatus::kDone);
      line.create();
    }
  }
}

// A frame of another program on this host is marked; that is how a second controller is noticed.
TEST(CanSocketOnKernel, SenderOnThisHostIsMarked) {
  CanSocket socket(CanSocketParams{"can0"});
  ASSERT_EQ(socket.open(), "");
  BareSocket same_host("can0");
  BareSocket other_node("can1");
  ReceivedFrame received;
  ASSERT_TRUE(same_host.send(kernel_frame(0x201)));
  ASSERT_EQ(receive(socket, received), TransferStatus::kDone);
  EXPECT_TRUE(received.from_this_host);
  ASSERT_TRUE(other_node.send(kernel_frame(0x181)));
  ASSERT_EQ(receive(socket, received), TransferStatus::kDone);
  EXPECT_EQ(received.frame.id, 0x181U);
  EXPECT_FALSE(received.from_this_host);
}

// On a virtual bus frames are out at once; so they are on the emulated controller, a moment later.
TEST(CanSocketOnKernel, SentFramesLeave) {
  const VirtualCan line("lt0");
  for (const std::string interface : {"lt0", "can0"}) {
    CanSocket socket(CanSocketParams{interface});
    ASSERT_EQ(socket.open(), "");
    EXPECT_FALSE(socket.has_unsent_frames());
    EXPECT_EQ(socket.send(sync_frame()), TransferStatus::kDone);
    for (int i = 0; i < 1000 && socket.has_unsent_frames(); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_FALSE(socket.has_unsent_frames()) << interface;
  }
}

/// A pair of interfaces, one the other's peer, whose queue passes about one frame a second.
class SlowLine : public ::testing::Test {
 protected:
  void SetUp() override {
    hardware::shell("ip link add ltx0 type vxcan peer name ltx1");
    hardware::shell("ip link set ltx0 txqueuelen 10 up && ip link set ltx1 up");
    hardware::shell("tc qdisc add dev ltx0 root tbf rate 128bit burst 32 limit 160");
  }
  void TearDown() override { hardware::shell("ip link del ltx0"); }
};

// A queue that does not drain is seen, a full one is said, and a purge throws all of it away: not
// one frame of before the purge reaches the bus.
TEST_F(SlowLine, PurgeLeavesNoStaleFrame) {
  CanSocket socket(CanSocketParams{"ltx0"});
  ASSERT_EQ(socket.open(), "");
  BareSocket peer("ltx1");
  TransferStatus status = TransferStatus::kDone;
  for (int i = 0; i < 100 && status == TransferStatus::kDone; ++i) {
    status = socket.send(sync_frame());
  }
  EXPECT_EQ(status, TransferStatus::kNoBuffers);
  EXPECT_TRUE(socket.has_unsent_frames());
  ASSERT_EQ(socket.purge_transmit_queue(), PurgeResult::kPurged);
  while (peer.receive(0)) {
  }  // what had left before
  EXPECT_FALSE(socket.has_unsent_frames());
  EXPECT_FALSE(peer.receive(3000));
  hardware::shell("tc qdisc del dev ltx0 root");
  CanFrame fresh = sync_frame();
  fresh.id = 0x201;
  ASSERT_EQ(socket.send(fresh), TransferStatus::kDone);
  const auto arrived = peer.receive();
  ASSERT_TRUE(arrived);
  EXPECT_EQ(arrived->can_id, 0x201U);
}

}  // namespace
