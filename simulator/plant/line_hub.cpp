// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/plant/line_hub.h"

#include <string_view>

#include <fcntl.h>
#include <unistd.h>

#include "simulator/plant/frame_gateway.h"

namespace simulator {
namespace {

constexpr std::size_t kRecordBytes = 2;
constexpr std::uint8_t kLetGo = 2;

std::array<std::byte, kRecordBytes> record(std::size_t line, bool level) {
  return {static_cast<std::byte>(line), static_cast<std::byte>(level ? 1 : 0)};
}

}  // namespace

LineHub::LineHub(const std::string& path) : server_(path, kRecordBytes) {}

void LineHub::add_client(int descriptor) {
  server_.add_client(descriptor);
  greet(descriptor);
}

void LineHub::greet(int client) {
  for (std::size_t line = 0; line < levels_.size(); ++line) {
    server_.send_to(client, record(line, levels_[line]));
  }
}

std::vector<LineHub::Hand> LineHub::receive() {
  std::vector<Hand> hands;
  const auto take = [&hands](int, PacketServer::Bytes packet) {
    const auto line = static_cast<std::uint8_t>(packet[0]);
    const auto level = static_cast<std::uint8_t>(packet[1]);
    if (line >= kNumLines || level > kLetGo) return;
    const WireFault fault = level == kLetGo ? WireFault::kNone
                            : level == 1    ? WireFault::kStuckHigh
                                            : WireFault::kStuckLow;
    hands.push_back({static_cast<Line>(line), fault});
  };
  server_.receive(take, [this](int client) { greet(client); });
  return hands;
}

void LineHub::publish(const LineLevels& levels) {
  for (std::size_t line = 0; line < levels.size(); ++line) {
    if (levels[line] == levels_[line]) continue;
    levels_[line] = levels[line];
    server_.broadcast(record(line, levels[line]));
  }
}

SimulatedChip::SimulatedChip(const std::string& folder, const std::array<int, kNumLines>& offsets) {
  for (std::size_t line = 0; line < offsets.size(); ++line) {
    const std::string path = folder + "/sim_gpio" + std::to_string(offsets[line]) + "/pull";
    pulls_[line] = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (pulls_[line] < 0) throw DoorError("cannot write " + path + "; is gpio-sim set up?");
  }
}

SimulatedChip::~SimulatedChip() {
  for (const int pull : pulls_) {
    if (pull >= 0) ::close(pull);
  }
}

bool SimulatedChip::write(std::size_t line, bool level) const {
  const std::string_view text = level ? "pull-up" : "pull-down";
  return ::pwrite(pulls_[line], text.data(), text.size(), 0) == static_cast<ssize_t>(text.size());
}

bool SimulatedChip::publish(const LineLevels& levels) {
  bool written = true;
  for (std::size_t line = 0; line < levels.size(); ++line) {
    const bool is_known = levels_ && (*levels_)[line] == levels[line];
    if (!is_known || line == refreshed_) written &= write(line, levels[line]);
  }
  refreshed_ = (refreshed_ + 1) % levels.size();
  levels_ = levels;
  return written;
}

}  // namespace simulator
