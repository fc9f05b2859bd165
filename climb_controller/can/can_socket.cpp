// SPDX-License-Identifier: BSD-3-Clause
#include "can/can_socket.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <utility>

#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <linux/sock_diag.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "can/kernel_frame.h"

namespace can {
namespace {

constexpr const char* kUnixPrefix = "unix:";

// Without CAN_ERR_BUSERROR, which may flood.
constexpr can_err_mask_t kErrorFilter = CAN_ERR_TX_TIMEOUT | CAN_ERR_CRTL | CAN_ERR_TRX |
                                        CAN_ERR_ACK | CAN_ERR_BUSOFF | CAN_ERR_RESTARTED;

template <class Value>
bool set_option(int fd, int level, int option, const Value& value) {
  return ::setsockopt(fd, level, option, &value, sizeof value) == 0;
}

std::string because(const std::string& what) {
  return what + ": " + std::strerror(errno);
}

ifreq request_for(const std::string& interface) {
  ifreq request{};
  std::strncpy(request.ifr_name, interface.c_str(), IFNAMSIZ - 1);
  return request;
}

std::int64_t kernel_time_us(msghdr& message) {
  for (cmsghdr* part = CMSG_FIRSTHDR(&message); part != nullptr;
       part = CMSG_NXTHDR(&message, part)) {
    if (part->cmsg_level != SOL_SOCKET || part->cmsg_type != SCM_TIMESTAMPNS) continue;
    timespec time{};
    std::memcpy(&time, CMSG_DATA(part), sizeof time);
    return std::int64_t{time.tv_sec} * 1'000'000 + time.tv_nsec / 1000;
  }
  return 0;
}

/// The interface down and up again: its queue is emptied by the kernel.
PurgeResult flap(const std::string& interface) {
  const int fd = ::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW);
  if (fd < 0) return PurgeResult::kFailed;
  ifreq request = request_for(interface);
  PurgeResult result = PurgeResult::kFailed;
  if (::ioctl(fd, SIOCGIFFLAGS, &request) == 0) {
    const auto flags = request.ifr_flags;
    request.ifr_flags = static_cast<short>(flags & ~IFF_UP);
    if (::ioctl(fd, SIOCSIFFLAGS, &request) == 0) {
      request.ifr_flags = static_cast<short>(flags | IFF_UP);
      if (::ioctl(fd, SIOCSIFFLAGS, &request) == 0) result = PurgeResult::kPurged;
    } else if (errno == EPERM || errno == EACCES) {
      result = PurgeResult::kNotPermitted;
    }
  }
  ::close(fd);
  return result;
}

}  // namespace

TransferStatus classify_errno(int error) {
  switch (error) {
    case EAGAIN:
      return TransferStatus::kWouldBlock;
    case ENOBUFS:
      return TransferStatus::kNoBuffers;
    case ENETDOWN:
      return TransferStatus::kNetworkDown;
    case ENXIO:
    case ENODEV:
    case EPIPE:
    case ECONNRESET:
    case ENOTCONN:
    case EBADF:
      return TransferStatus::kGone;
    default:
      return TransferStatus::kRefused;
  }
}

CanSocket::CanSocket(CanSocketParams params)
    : params_(std::move(params)), backoff_us_(params_.first_reopen_us) {}

CanSocket::CanSocket(int fd) : fd_(fd) {
  params_.interface.clear();
  set_option(fd_, SOL_SOCKET, SO_TIMESTAMPNS, 1);
}

CanSocket::~CanSocket() {
  if (fd_ >= 0) ::close(fd_);
}

bool CanSocket::is_unix() const {
  return params_.interface.empty() || params_.interface.rfind(kUnixPrefix, 0) == 0;
}

std::string CanSocket::open() {
  if (fd_ >= 0) return "";
  if (params_.interface.empty()) return "a line made from a descriptor cannot be opened again";
  const std::string error = is_unix() ? open_unix() : open_raw();
  if (fd_ >= 0) set_option(fd_, SOL_SOCKET, SO_TIMESTAMPNS, 1);
  return error;
}

std::string CanSocket::open_raw() {
  const std::string& interface = params_.interface;
  const int fd = ::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
  if (fd < 0) return because("no CAN in this kernel (modprobe can_raw)");
  ifreq request = request_for(interface);
  std::string error;
  sockaddr_can address{};
  address.can_family = AF_CAN;
  if (::ioctl(fd, SIOCGIFINDEX, &request) != 0) {
    error = because("no interface " + interface);
  } else {
    address.can_ifindex = request.ifr_ifindex;
    if (::ioctl(fd, SIOCGIFFLAGS, &request) != 0 || (request.ifr_flags & IFF_UP) == 0) {
      error = interface + " is down (ip link set " + interface + " up)";
    } else if (!set_option(fd, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, kErrorFilter)) {
      error = because(interface + " delivers no error frames");
    } else if (::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
      error = because("cannot bind to " + interface);
    }
  }
  if (!error.empty()) {
    ::close(fd);
    return error;
  }
  set_option(fd, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, 1);  // so that FD frames are seen and counted
  fd_ = fd;
  return "";
}

std::string CanSocket::open_unix() {
  const std::string path = params_.interface.substr(std::strlen(kUnixPrefix));
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof address.sun_path) return "bad path in unix:" + path;
  std::copy(path.begin(), path.end(), address.sun_path);
  const int fd = ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (fd < 0) return because("no unix socket");
  if (::connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    const std::string error = because("nobody listens at " + path);
    ::close(fd);
    return error;
  }
  fd_ = fd;
  return "";
}

TransferStatus CanSocket::lose(TransferStatus status) {
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
  lost_ = status;
  next_attempt_us_ = 0;
  backoff_us_ = params_.first_reopen_us;
  return status;
}

TransferStatus CanSocket::failed(int error) {
  const TransferStatus status = classify_errno(error);
  const bool is_lost = status == TransferStatus::kNetworkDown || status == TransferStatus::kGone;
  return is_lost ? lose(status) : status;
}

TransferStatus CanSocket::send(const CanFrame& frame) {
  if (fd_ < 0) return lost_;
  const ::can_frame kernel = to_kernel(frame);
  const ssize_t sent = ::send(fd_, &kernel, sizeof kernel, MSG_DONTWAIT | MSG_NOSIGNAL);
  if (sent == static_cast<ssize_t>(sizeof kernel)) return TransferStatus::kDone;
  return failed(sent < 0 ? errno : EIO);
}

TransferStatus CanSocket::receive(ReceivedFrame& received) {
  if (fd_ < 0) return lost_;
  canfd_frame raw{};
  iovec place{&raw, sizeof raw};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(timespec))> control{};
  msghdr message{};
  message.msg_iov = &place;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  const ssize_t size = ::recvmsg(fd_, &message, MSG_DONTWAIT);
  if (size < 0) return failed(errno);
  if (size == 0) return lose(TransferStatus::kGone);  // the peer of a unix: line has closed
  ::can_frame kernel{};
  std::memcpy(&kernel, &raw, std::min<std::size_t>(static_cast<std::size_t>(size), CAN_MTU));
  kernel.can_dlc = std::min<std::uint8_t>(kernel.can_dlc, CAN_MAX_DLEN);
  received.frame = from_kernel(kernel);
  received.frame.fd = static_cast<std::size_t>(size) != CAN_MTU || raw.len > CAN_MAX_DLEN;
  received.receive_us = kernel_time_us(message);
  received.from_this_host = (message.msg_flags & MSG_DONTROUTE) != 0;
  return TransferStatus::kDone;
}

bool CanSocket::has_unsent_frames() const {
  if (fd_ < 0) return false;
  std::array<std::uint32_t, SK_MEMINFO_VARS> memory{};
  socklen_t size = sizeof memory;
  if (::getsockopt(fd_, SOL_SOCKET, SO_MEMINFO, memory.data(), &size) != 0) return false;
  return memory[SK_MEMINFO_WMEM_ALLOC] > 0;
}

bool CanSocket::maintain(std::int64_t now_us) {
  if (fd_ >= 0) return true;
  if (params_.interface.empty() || now_us < next_attempt_us_) return false;
  if (open().empty()) {
    backoff_us_ = params_.first_reopen_us;
    return true;
  }
  next_attempt_us_ = now_us + backoff_us_;
  backoff_us_ = std::min(2 * backoff_us_, params_.longest_reopen_us);
  return false;
}

PurgeResult CanSocket::purge_transmit_queue() {
  if (is_unix()) {
    // What a peer has not yet read cannot be taken back.
    return has_unsent_frames() ? PurgeResult::kFailed : PurgeResult::kPurged;
  }
  const PurgeResult result = flap(params_.interface);
  if (result != PurgeResult::kPurged) return result;
  lose(TransferStatus::kNetworkDown);  // the old socket would report ENETDOWN once more
  return open().empty() ? PurgeResult::kPurged : PurgeResult::kFailed;
}

}  // namespace can
