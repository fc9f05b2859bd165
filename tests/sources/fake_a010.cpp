// SPDX-License-Identifier: BSD-3-Clause
#include "fake_a010.h"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <numeric>
#include <stdexcept>

#include <fcntl.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

namespace sources {

std::vector<std::uint8_t> a010_packet(const std::vector<std::uint8_t>& counts, int side,
                                      int number) {
  const int length = 16 + side * side;
  const auto low = [](int value) { return static_cast<std::uint8_t>(value & 0xFF); };
  std::vector<std::uint8_t> packet;
  packet.reserve(static_cast<std::size_t>(length) + 6);
  packet = {0x00, 0xFF, low(length), low(length >> 8), 0xFF, 0x00};
  for (const int byte : {41, 43,                  // temperatures
                         0xE8, 0x03, 0x00, 0x00,  // exposure
                         0x00, 0x00, side, side,  // no error, size
                         number, number >> 8, 0x01, 0xFF}) {
    packet.push_back(low(byte));
  }
  packet.insert(packet.end(), counts.begin(), counts.end());
  packet.push_back(low(std::accumulate(packet.begin(), packet.end(), 0)));
  packet.push_back(0xDD);
  return packet;
}

FakeA010::FakeA010(const std::string& link) : link_(link) {
  master_ = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (master_ < 0 || grantpt(master_) != 0 || unlockpt(master_) != 0)
    throw std::runtime_error("no pseudo terminal");
  std::array<char, 64> name{};
  ptsname_r(master_, name.data(), name.size());
  path_ = name.data();
  // Raw from the start: a fresh terminal would echo our images back to us.
  const int slave = open(path_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  termios settings{};
  tcgetattr(slave, &settings);
  cfmakeraw(&settings);
  tcsetattr(slave, TCSANOW, &settings);
  close(slave);
  if (link_.empty()) return;
  unlink(link_.c_str());
  if (symlink(path_.c_str(), link_.c_str()) != 0) throw std::runtime_error("no link " + link_);
}

FakeA010::~FakeA010() {
  close(master_);
  if (!link_.empty()) unlink(link_.c_str());
}

void FakeA010::work() {
  std::array<char, 256> bytes{};
  for (;;) {
    const ssize_t size = read(master_, bytes.data(), bytes.size());
    if (size <= 0) break;
    received_.append(bytes.data(), static_cast<std::size_t>(size));
  }
  for (std::size_t end = received_.find('\r'); end != std::string::npos;
       end = received_.find('\r')) {
    const std::string command = received_.substr(0, end);
    received_.erase(0, end + 1);
    commands_.push_back(command);
    if (!is_mute) answer(command);
  }
}

void FakeA010::answer(const std::string& command) {
  const std::size_t equals = command.find('=');
  if (command.starts_with("AT+") && equals != std::string::npos)
    settings_[command.substr(3, equals - 3)] = std::atoi(command.c_str() + equals + 1);
  send_text("OK\r\n");
}

void FakeA010::send(const std::vector<std::uint8_t>& bytes) {
  for (std::size_t sent = 0; sent < bytes.size();) {
    const ssize_t size = write(master_, bytes.data() + sent, bytes.size() - sent);
    if (size > 0) {
      sent += static_cast<std::size_t>(size);
      continue;
    }
    if (errno != EAGAIN) return;  // nobody holds the other end
    pollfd waiting{master_, POLLOUT, 0};
    if (poll(&waiting, 1, 1000) == 0) throw std::runtime_error("nobody reads the line");
  }
}

void FakeA010::send_image(std::uint8_t count) {
  const int side = 100 / setting("BINN");
  send(a010_packet(std::vector<std::uint8_t>(static_cast<std::size_t>(side * side), count), side,
                   number));
  number = (number + 1) % 4096;
}

int FakeA010::setting(const std::string& name) const {
  const auto found = settings_.find(name);
  return found == settings_.end() ? -1 : found->second;
}

}  // namespace sources
