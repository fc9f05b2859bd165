// SPDX-License-Identifier: BSD-3-Clause
// One scripted ODrive: heartbeat every 100 ms, estimates every 10 ms, armed by Set_Axis_State; it
// is where it is told to be at once. Speaks hexadecimal, no code of can/odrive.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>

#include "fake_line.h"

namespace can {

class OdriveMotor {
 public:
  explicit OdriveMotor(std::uint8_t node = 1) : node_id(node) {}

  void hear(const CanFrame& frame) {
    if (frame.id >> 5 != node_id) return;
    const std::uint32_t command = frame.id & 0x1F;
    if (command == 0x07) state = frame.data[0];
    if (command == 0x0C && state == 8) estimates = hex(frame).substr(4, 8);
    if (command == 0x0C && first_target.empty()) first_target = hex(frame).substr(4, 8);
    if (command == 0x18) error = 0;
  }

  void speak(FakeLine& line, std::int64_t time_ms) const {
    if (is_silent) return;
    char text[40];
    std::snprintf(text, sizeof text, "%03X#%02X000000%02X000000", node_id << 5 | 0x01, error,
                  state);
    if (time_ms % 100 == 0) line.put(from_hex(text));
    std::snprintf(text, sizeof text, "%03X#", node_id << 5 | 0x09);
    if (time_ms % 10 == 5) line.put(from_hex(text + estimates + "00000000"));
  }

  std::uint32_t node_id;
  int state = 1;
  int error = 0;
  bool is_silent = false;
  std::string estimates = "0000803F";  // 1.0 revolution
  std::string first_target;
};

}  // namespace can
