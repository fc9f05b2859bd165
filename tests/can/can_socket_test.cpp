// SPDX-License-Identifier: BSD-3-Clause
// The socket door on what every host has: socket pairs, unix: lines, errno. Raw interfaces are
// tested where the kernel has CAN (tests/hardware).
#include "can/can_socket.h"

#include <cerrno>
#include <cstring>
#include <string>

#include <gtest/gtest.h>
#include <linux/can.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "can/kernel_frame.h"
#include "fake_line.h"
#include "tests/support/temporary_folder.h"

namespace can {
namespace {

/// Two ends of one line.
struct Pair {
  Pair() { EXPECT_EQ(::socketpair(AF_UNIX, SOCK_SEQPACKET, 0, fds), 0); }
  ~Pair() { ::close(fds[1]); }
  int fds[2] = {-1, -1};  ///< [0] is taken over by a CanSocket
};

/// A listening unix: line.
class Listener {
 public:
  Listener() { listen(); }
  ~Listener() { close(); }
  void listen() {
    fd = ::socket(AF_UNIX, SOCK_SEQPACKET, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strcpy(address.sun_path, path.c_str());
    EXPECT_EQ(::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    EXPECT_EQ(::listen(fd, 1), 0);
  }
  void close() {
    ::close(fd);
    ::unlink(path.c_str());
  }
  support::TemporaryFolder folder;
  std::string path = folder / "line";
  int fd = -1;
};

// A frame crosses as one struct can_frame in both directions, all sixteen bytes.
TEST(CanSocket, FrameCrossesOneForOne) {
  Pair pair;
  CanSocket socket(pair.fds[0]);
  EXPECT_EQ(socket.send(from_hex("181#2706E8030000F4FF")), TransferStatus::kDone);
  ::can_frame raw{};
  ASSERT_EQ(::recv(pair.fds[1], &raw, sizeof raw, 0), 16);
  EXPECT_EQ(raw.can_id, 0x181U);
  EXPECT_EQ(raw.can_dlc, 8);
  EXPECT_EQ(raw.data[7], 0xFF);
  raw.can_id = 0x1234567U | CAN_EFF_FLAG;
  raw.can_dlc = 2;
  ASSERT_EQ(::send(pair.fds[1], &raw, sizeof raw, 0), 16);
  ReceivedFrame received;
  ASSERT_EQ(socket.receive(received), TransferStatus::kDone);
  EXPECT_EQ(hex(received.frame), "01234567#2706");
  EXPECT_TRUE(received.frame.extended);
  EXPECT_EQ(received.frame.data[2], 0);  // nothing behind dlc
  EXPECT_EQ(socket.receive(received), TransferStatus::kWouldBlock);
}

// Flags survive both ways; an error frame keeps its class.
TEST(CanSocket, FlagsOfTheKernel) {
  CanFrame remote = from_hex("123#");
  remote.remote = true;
  remote.dlc = 4;
  EXPECT_EQ(from_kernel(to_kernel(remote)), remote);
  ::can_frame error{};
  error.can_id = 0x40 | CAN_ERR_FLAG;
  error.can_dlc = 8;
  const CanFrame frame = from_kernel(error);
  EXPECT_TRUE(frame.error);
  EXPECT_EQ(frame.id, 0x40U);
  EXPECT_EQ(to_kernel(frame).can_id, error.can_id);
  EXPECT_EQ(to_kernel(from_hex("7FF#")).can_id, 0x7FFU);
}

// Messages of another size or with a length above eight are seen, marked, and kill nothing.
TEST(CanSocket, OddMessages) {
  Pair pair;
  CanSocket socket(pair.fds[0]);
  char bytes[100] = {};
  ReceivedFrame received;
  for (const int size : {1, 4, 15, 17, 72, 100}) {
    ASSERT_EQ(::send(pair.fds[1], bytes, static_cast<std::size_t>(size), 0), size);
    ASSERT_EQ(socket.receive(received), TransferStatus::kDone);
    EXPECT_TRUE(received.frame.fd) << size;
    EXPECT_LE(received.frame.dlc, 8);
  }
  for (int length = 0; length < 256; ++length) {
    ::can_frame raw{};
    raw.can_dlc = static_cast<std::uint8_t>(length);
    ASSERT_EQ(::send(pair.fds[1], &raw, sizeof raw, 0), 16);
    ASSERT_EQ(socket.receive(received), TransferStatus::kDone);
    EXPECT_EQ(received.frame.fd, length > 8);
    EXPECT_EQ(received.frame.dlc, length > 8 ? 8 : length);
  }
}

// A peer that does not read: unsent frames are seen, then sending would block; never a wait.
TEST(CanSocket, PeerThatDoesNotRead) {
  Pair pair;
  CanSocket socket(pair.fds[0]);
  EXPECT_FALSE(socket.has_unsent_frames());
  EXPECT_EQ(socket.purge_transmit_queue(), PurgeResult::kPurged);
  TransferStatus status = socket.send(from_hex("080#"));
  EXPECT_TRUE(socket.has_unsent_frames());
  EXPECT_EQ(socket.purge_transmit_queue(), PurgeResult::kFailed);
  int num_sent = 1;
  while (status == TransferStatus::kDone && num_sent < 100'000) {
    status = socket.send(from_hex("080#"));
    ++num_sent;
  }
  EXPECT_EQ(status, TransferStatus::kWouldBlock);
  ::can_frame raw{};
  for (int i = 0; i < num_sent - 1; ++i) ASSERT_EQ(::recv(pair.fds[1], &raw, sizeof raw, 0), 16);
  EXPECT_FALSE(socket.has_unsent_frames());
  EXPECT_EQ(socket.send(from_hex("080#")), TransferStatus::kDone);
}

// A peer that goes away loses the line for good; the reason is kept.
TEST(CanSocket, PeerGone) {
  Pair pair;
  CanSocket socket(pair.fds[0]);
  ::shutdown(pair.fds[1], SHUT_RDWR);
  ReceivedFrame received;
  EXPECT_EQ(socket.receive(received), TransferStatus::kGone);
  EXPECT_EQ(socket.receive(received), TransferStatus::kGone);
  EXPECT_EQ(socket.send(from_hex("080#")), TransferStatus::kGone);
  EXPECT_FALSE(socket.maintain(0));
  EXPECT_EQ(socket.fd(), -1);
}

// A unix: line is opened by path, lost with its hub, tried again with growing pauses, and found.
TEST(CanSocket, UnixLineComesBack) {
  Listener hub;
  CanSocket socket(CanSocketParams{"unix:" + hub.path});
  ASSERT_TRUE(socket.maintain(0));
  int peer = ::accept(hub.fd, nullptr, nullptr);
  EXPECT_EQ(socket.send(from_hex("201#0F00")), TransferStatus::kDone);
  hub.close();
  ::close(peer);
  ReceivedFrame received;
  while (socket.receive(received) == TransferStatus::kDone) {
  }
  EXPECT_EQ(socket.fd(), -1);
  EXPECT_FALSE(socket.maintain(1'000'000));
  EXPECT_FALSE(socket.maintain(1'050'000));
  hub.listen();
  EXPECT_FALSE(socket.maintain(1'140'000));  // the second pause is 100 ms
  EXPECT_TRUE(socket.maintain(1'150'000));
  peer = ::accept(hub.fd, nullptr, nullptr);
  EXPECT_EQ(socket.send(from_hex("080#")), TransferStatus::kDone);
  ::close(peer);
}

// What cannot be opened says why and how to mend it.
TEST(CanSocket, OpenSaysWhy) {
  EXPECT_NE(CanSocket(CanSocketParams{"unix:/nowhere/line"}).open().find("/nowhere/line"),
            std::string::npos);
  EXPECT_NE(CanSocket(CanSocketParams{"unix:"}).open(), "");
  EXPECT_NE(CanSocket(CanSocketParams{"unix:" + std::string(200, 'x')}).open(), "");
  EXPECT_NE(CanSocket(CanSocketParams{"nocan9"}).open(), "");
}

// Every errno that a CAN line is known to give has its meaning.
TEST(CanSocket, ErrnoClasses) {
  EXPECT_EQ(classify_errno(ENOBUFS), TransferStatus::kNoBuffers);
  EXPECT_EQ(classify_errno(ENETDOWN), TransferStatus::kNetworkDown);
  EXPECT_EQ(classify_errno(ENXIO), TransferStatus::kGone);
  EXPECT_EQ(classify_errno(ENODEV), TransferStatus::kGone);
  EXPECT_EQ(classify_errno(EAGAIN), TransferStatus::kWouldBlock);
  EXPECT_EQ(classify_errno(EMSGSIZE), TransferStatus::kRefused);
}

}  // namespace
}  // namespace can
