// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/plant/socket_can_port.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include "simulator/plant/unix_frame_server.h"

namespace simulator {
namespace {

constexpr const char* kUnixPrefix = "unix:";

}  // namespace

BusFrame from_kernel(const ::can_frame& frame) {
  BusFrame taken;
  taken.id = frame.can_id;
  taken.length = std::min<std::uint8_t>(frame.can_dlc, 8);
  std::copy_n(frame.data, taken.bytes.size(), taken.bytes.begin());
  for (std::size_t i = taken.length; i < taken.bytes.size(); ++i) taken.bytes[i] = 0;
  return taken;
}

::can_frame to_kernel(const BusFrame& frame) {
  ::can_frame kernel{};
  kernel.can_id = frame.id;
  kernel.can_dlc = frame.length;
  std::copy(frame.bytes.begin(), frame.bytes.end(), kernel.data);
  return kernel;
}

std::unique_ptr<FrameGateway> open_gateway(const std::string& interface) {
  if (interface.rfind(kUnixPrefix, 0) == 0) {
    return std::make_unique<UnixFrameServer>(interface.substr(std::strlen(kUnixPrefix)));
  }
  return std::make_unique<SocketCanPort>(interface);
}

SocketCanPort::SocketCanPort(const std::string& interface) {
  descriptor_ = ::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
  if (descriptor_ < 0) {
    throw DoorError(std::string("no CAN in this kernel: ") + std::strerror(errno) +
                    "; use unix:PATH");
  }
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(::if_nametoindex(interface.c_str()));
  const can_err_mask_t errors = CAN_ERR_MASK;
  ::setsockopt(descriptor_, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof errors);
  const bool bound =
      address.can_ifindex > 0 &&
      ::bind(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  if (bound) return;
  const std::string reason = std::strerror(errno);
  ::close(descriptor_);
  throw DoorError("cannot use " + interface + ": " + reason + "; ip link set " + interface + " up");
}

SocketCanPort::~SocketCanPort() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void SocketCanPort::add_to_poll(std::vector<pollfd>& descriptors) const {
  descriptors.push_back({descriptor_, POLLIN, 0});
}

void SocketCanPort::receive(std::vector<BusFrame>& frames) {
  ::can_frame frame{};
  while (::recv(descriptor_, &frame, sizeof frame, MSG_DONTWAIT) ==
         static_cast<ssize_t>(sizeof frame)) {
    frames.push_back(from_kernel(frame));
  }
}

void SocketCanPort::send(const BusFrame& frame) {
  const ::can_frame kernel = to_kernel(frame);
  if (::send(descriptor_, &kernel, sizeof kernel, MSG_DONTWAIT) !=
      static_cast<ssize_t>(sizeof kernel)) {
    ++num_lost_;
  }
}

}  // namespace simulator
