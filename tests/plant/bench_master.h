// SPDX-License-Identifier: BSD-3-Clause
// A hand-made master for tests of one drive: each frame written out by bytes, so that the test
// reads like the wire contract and shares no code with the controller.
#pragma once

#include <initializer_list>
#include <optional>
#include <vector>

#include "simulator/plant/drive.h"

namespace simulator {

inline BusFrame frame_of(std::uint32_t id, std::initializer_list<int> bytes) {
  BusFrame frame;
  frame.id = id;
  for (const int byte : bytes) frame.bytes[frame.length++] = static_cast<std::uint8_t>(byte);
  return frame;
}

/// One drive and a master beside it in virtual time.
struct DriveBench {
  explicit DriveBench(const DriveParams& params = {}) : drive(params) { advance(30'000); }

  void advance(std::int64_t by_us) {
    for (const std::int64_t end_us = now_us + by_us; now_us < end_us;) {
      now_us += Drive::kStep_us;
      drive.advance(now_us, sent);
    }
  }
  void send(const BusFrame& frame) { drive.receive(frame, now_us, sent); }

  /// The answer's command byte and number; none = silence.
  struct Answer {
    int command = 0;
    std::uint32_t number = 0;
  };
  std::optional<Answer> ask(const BusFrame& request) {
    const std::size_t before = sent.size();
    send(request);
    for (std::size_t i = before; i < sent.size(); ++i) {
      if (sent[i].id == 0x580U + node) return Answer{sent[i].bytes[0], number_at(sent[i], 4, 4)};
    }
    return std::nullopt;
  }
  std::optional<Answer> read(int index, int subindex = 0) {
    return ask(frame_of(0x600 + node, {0x40, index & 0xFF, index >> 8, subindex, 0, 0, 0, 0}));
  }
  std::optional<Answer> write(int index, int subindex, std::uint32_t value, int num_bytes) {
    BusFrame frame = frame_of(0x600 + node, {0x23 | (4 - num_bytes) << 2, index & 0xFF, index >> 8,
                                             subindex, 0, 0, 0, 0});
    put_number(frame, 4, 4, value);
    return ask(frame);
  }
  void heartbeat() { send(frame_of(0x77F, {0x05})); }
  void nmt(int command) { send(frame_of(0x000, {command, static_cast<int>(node)})); }
  void sync() { send(frame_of(0x080, {})); }
  void command(int control_word, double target_rad, int torque_permille = 1500) {
    BusFrame frame = frame_of(0x200 + node, {0, 0, 0, 0, 0, 0, 0, 0});
    put_number(frame, 0, 2, static_cast<std::uint32_t>(control_word));
    put_number(frame, 2, 4, static_cast<std::uint32_t>(drive.counts(target_rad)));
    put_number(frame, 6, 2, static_cast<std::uint32_t>(torque_permille));
    send(frame);
  }
  /// One cycle of 10 ms: command, SYNC, heartbeat of the master every fifth.
  void cycle(int control_word, double target_rad) {
    if (master_alive && num_cycles % 5 == 0) heartbeat();
    ++num_cycles;
    command(control_word, target_rad);
    sync();
    advance(10'000);
  }
  /// Configures as climb.md 2.5 asks, starts the node and enables it where it stands.
  void enable() {
    write(0x6060, 0, 8, 1);
    write(0x60C2, 1, 10, 1);
    write(0x60C2, 2, 0xFD, 1);
    write(0x605A, 0, 6, 2);
    write(0x6007, 0, 3, 2);
    write(0x6085, 0, static_cast<std::uint32_t>(20.0 * drive.params().counts_per_rad), 4);
    write(0x1016, 1, (0x7FU << 16) | 150U, 4);
    write(0x1017, 0, 100, 2);
    write(0x1029, 1, 1, 1);
    nmt(0x01);
    for (const int word : {0x06, 0x07, 0x0F, 0x0F}) cycle(word, drive.measured_rad());
  }
  /// Emergencies sent so far with this code.
  int num_emergencies(std::uint32_t code) const {
    int count = 0;
    for (const BusFrame& frame : sent) {
      count += frame.id == 0x80U + node && number_at(frame, 0, 2) == code ? 1 : 0;
    }
    return count;
  }

  Drive drive;
  std::uint32_t node = drive.node_id();
  std::int64_t now_us = 0;
  std::vector<BusFrame> sent;
  int num_cycles = 0;
  bool master_alive = true;
};

}  // namespace simulator
