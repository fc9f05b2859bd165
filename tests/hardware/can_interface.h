// SPDX-License-Identifier: BSD-3-Clause
// A CAN interface that a test makes, takes down, deletes and brings back, and a bare socket on it:
// the other node of the bus, with no code of ours in between. Needs root and ip(8).
#pragma once

#include <cstdlib>
#include <cstring>
#include <optional>
#include <string>

#include <gtest/gtest.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace hardware {

/// Runs a command that must succeed.
inline void shell(const std::string& command) {
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
}

/// A virtual interface of its own for each test; gone at the end.
class VirtualCan {
 public:
  explicit VirtualCan(std::string name) : name_(std::move(name)) { create(); }
  ~VirtualCan() { (void)std::system(("ip link del " + name_ + " 2>/dev/null").c_str()); }
  VirtualCan(const VirtualCan&) = delete;
  VirtualCan& operator=(const VirtualCan&) = delete;

  const std::string& name() const { return name_; }
  /// Room for CAN FD frames, as scripts/vm makes its own.
  void create() {
    shell("ip link add " + name_ + " type vcan && ip link set " + name_ +
          " mtu 72 && ip link set " + name_ + " up");
  }
  void remove() { shell("ip link del " + name_); }
  void up() { shell("ip link set " + name_ + " up"); }
  void down() { shell("ip link set " + name_ + " down"); }

 private:
  std::string name_;
};

/// The kernel's raw socket as it comes.
class BareSocket {
 public:
  explicit BareSocket(const std::string& interface)
      : descriptor_(::socket(PF_CAN, SOCK_RAW, CAN_RAW)) {
    const int on = 1;
    ::setsockopt(descriptor_, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof on);
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = static_cast<int>(::if_nametoindex(interface.c_str()));
    EXPECT_EQ(::bind(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0)
        << interface;
  }
  ~BareSocket() { ::close(descriptor_); }
  BareSocket(const BareSocket&) = delete;
  BareSocket& operator=(const BareSocket&) = delete;

  /// False when the kernel refuses the frame.
  template <class Frame>
  bool send(const Frame& frame) {
    return ::write(descriptor_, &frame, sizeof frame) == static_cast<ssize_t>(sizeof frame);
  }

  /// The next frame, waited for.
  std::optional<::can_frame> receive(int wait_ms = 2000) {
    pollfd waiting{descriptor_, POLLIN, 0};
    ::can_frame frame{};
    if (::poll(&waiting, 1, wait_ms) != 1) return std::nullopt;
    if (::read(descriptor_, &frame, sizeof frame) != static_cast<ssize_t>(sizeof frame)) {
      return std::nullopt;
    }
    return frame;
  }

 private:
  int descriptor_;
};

inline ::can_frame kernel_frame(canid_t id, const std::string& bytes = "") {
  ::can_frame frame{};
  frame.can_id = id;
  frame.can_dlc = static_cast<__u8>(bytes.size());
  std::memcpy(frame.data, bytes.data(), bytes.size());
  return frame;
}

}  // namespace hardware
