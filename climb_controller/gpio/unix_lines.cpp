// SPDX-License-Identifier: BSD-3-Clause
#include "gpio/unix_lines.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace gpio {
namespace {

constexpr std::size_t kPacketBytes = 2;
constexpr std::uint8_t kAllTold = (1U << kNumLines) - 1U;
// More in one reading (a socket holds a few hundred) is a flood that could hide a level for ever.
constexpr int kMaxPackets = 2000;

}  // namespace

UnixLines::UnixLines(std::string path) : path_(std::move(path)) {}

UnixLines::UnixLines(int fd) : fd_(fd) {}

UnixLines::~UnixLines() {
  close();
}

void UnixLines::close() {
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
  told_ = 0;
}

std::string UnixLines::open() {
  if (path_.empty()) return fd_ >= 0 ? "" : "lines made from a descriptor cannot be opened again";
  close();
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path_.size() >= sizeof address.sun_path) return "unix:" + path_ + " is too long for a socket";
  std::copy(path_.begin(), path_.end(), address.sun_path);
  const int fd = ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (fd < 0) return std::string("no unix socket: ") + std::strerror(errno);
  if (::connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    const int error = errno;
    ::close(fd);
    return "no line hub listens at " + path_ + " (" + std::strerror(error) +
           "); start the simulated robot first, or correct gpio.chip";
  }
  fd_ = fd;
  return "";
}

ReadStatus UnixLines::read(Levels& levels) {
  int num_packets = 0;
  while (fd_ >= 0 && take_packet()) {
    if (++num_packets > kMaxPackets) {
      loss_ = "it floods us";
      close();
    }
  }
  if (fd_ < 0) return ReadStatus::kLost;
  if (told_ != kAllTold) return ReadStatus::kPending;
  levels = levels_;
  return ReadStatus::kDone;
}

bool UnixLines::take_packet() {
  std::array<std::uint8_t, kPacketBytes + 1> packet{};  // one more, to see what is too long
  const ssize_t size = ::recv(fd_, packet.data(), packet.size(), MSG_DONTWAIT);
  if (size < 0 && (errno == EAGAIN || errno == EINTR)) return false;
  if (size == static_cast<ssize_t>(kPacketBytes) && packet[0] < kNumLines && packet[1] <= 1) {
    levels_[packet[0]] = packet[1] == 1;
    told_ |= static_cast<std::uint8_t>(1U << packet[0]);
    return true;
  }
  loss_ = size == 0  ? "it has gone"
          : size < 0 ? "the connection broke"
                     : "it sent something that is not {line 0..4, level 0 or 1}";
  close();
  return false;
}

std::string UnixLines::loss() const {
  if (*loss_ == '\0') return "";
  return "line hub" + (path_.empty() ? std::string() : " at " + path_) + ": " + loss_;
}

}  // namespace gpio
