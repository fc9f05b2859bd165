// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/plant/line_hub.h"

#include <fstream>

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
    pull_paths_[line] = folder + "/sim_gpio" + std::to_string(offsets[line]) + "/pull";
    if (!std::ofstream(pull_paths_[line], std::ios::in)) {
      throw DoorError("cannot write " + pull_paths_[line] + "; is gpio-sim set up?");
    }
  }
}

bool SimulatedChip::write(std::size_t line, bool level) const {
  std::ofstream file(pull_paths_[line]);
  file << (level ? "pull-up" : "pull-down") << std::flush;
  return static_cast<bool>(file);
}

bool SimulatedChip::publish(const LineLevels& levels) {
  bool written = true;
  for (std::size_t line = 0; line < levels.size(); ++line) {
    if (levels_ && (*levels_)[line] == levels[line]) continue;
    written &= write(line, levels[line]);
  }
  levels_ = levels;
  return written;
}

}  // namespace simulator
