// SPDX-License-Identifier: BSD-3-Clause
#include "sources/serial_line.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

namespace sources {
namespace {

constexpr std::array<std::pair<int, speed_t>, 9> kSpeeds{{{9600, B9600},
                                                          {57600, B57600},
                                                          {115200, B115200},
                                                          {230400, B230400},
                                                          {460800, B460800},
                                                          {921600, B921600},
                                                          {1000000, B1000000},
                                                          {2000000, B2000000},
                                                          {3000000, B3000000}}};

speed_t speed_of(int baud) {
  for (const auto& [known, speed] : kSpeeds) {
    if (known == baud) return speed;
  }
  return B0;
}

}  // namespace

bool is_known_baud(int baud) {
  return speed_of(baud) != B0;
}

SerialLine::~SerialLine() {
  close();
}

std::string SerialLine::open(const std::string& path, int baud) {
  close();
  fd_ = ::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (fd_ < 0) return std::string("cannot be opened: ") + std::strerror(errno);
  termios settings{};
  if (tcgetattr(fd_, &settings) != 0) {
    close();
    return "is no serial line";
  }
  cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  cfsetspeed(&settings, speed_of(baud));
  // Exclusively: a second reader would take bytes out of our images.
  if (tcsetattr(fd_, TCSANOW, &settings) != 0 || ioctl(fd_, TIOCEXCL) != 0) {
    close();
    return "refuses " + std::to_string(baud) + " baud";
  }
  tcflush(fd_, TCIOFLUSH);
  return "";
}

void SerialLine::close() {
  if (fd_ < 0) return;
  ioctl(fd_, TIOCNXCL);
  ::close(fd_);
  fd_ = -1;
}

std::size_t SerialLine::read(std::span<std::uint8_t> bytes) {
  if (fd_ < 0) return 0;
  const ssize_t size = ::read(fd_, bytes.data(), bytes.size());
  if (size > 0) return static_cast<std::size_t>(size);
  // A raw line without bytes says EAGAIN; 0 is the end of one that was hung up.
  if (size == 0 || (errno != EAGAIN && errno != EINTR)) close();
  return 0;
}

bool SerialLine::write(std::string_view text) {
  return fd_ >= 0 && ::write(fd_, text.data(), text.size()) == static_cast<ssize_t>(text.size());
}

}  // namespace sources
