// SPDX-License-Identifier: BSD-3-Clause
// The optional I/O node of a claw (climb.md's 0x21..0x24): touch bit and two forces by TPDO1 with
// every SYNC, heartbeat every 100 ms. 0.1 N per count; the lowest number means "no value".
#pragma once

#include <cstdint>
#include <vector>

#include "simulator/plant/bus_frame.h"

namespace simulator {

class ForceNode {
 public:
  static constexpr std::uint16_t kNoForce = 0x8000;

  explicit ForceNode(std::uint8_t node_id) : node_id_(node_id) {}

  void receive(const BusFrame& frame, std::vector<BusFrame>& sent);
  void advance(std::int64_t now_us, std::vector<BusFrame>& sent);

  bool touch = false;
  double across_N = 0.0;  ///< out of the ladder
  double down_N = 0.0;
  bool broken_sensor = false;  ///< fault: NaN instead of a force

 private:
  std::uint8_t node_id_;
  bool booted_ = false;
  bool operational_ = false;
  std::int64_t heartbeat_due_us_ = 0;
};

}  // namespace simulator
