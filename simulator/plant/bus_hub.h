// SPDX-License-Identifier: BSD-3-Clause
// Joins the plant's in-memory bus with a door to other processes: what comes in is sent on the bus
// at the time given, what crosses the bus goes out.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "simulator/plant/frame_gateway.h"
#include "simulator/plant/memory_bus.h"

namespace simulator {

class BusHub {
 public:
  BusHub(MemoryBus& bus, std::unique_ptr<FrameGateway> gateway);

  /// Frames from outside onto the bus. To be called before the plant advances to now.
  void take_in(std::int64_t now_us);
  /// Frames from the bus to the outside. To be called after.
  void give_out(std::int64_t now_us);

  FrameGateway& gateway() { return *gateway_; }
  std::int64_t num_taken() const { return num_taken_; }
  std::int64_t num_given() const { return num_given_; }

 private:
  MemoryBus& bus_;
  int port_;
  std::unique_ptr<FrameGateway> gateway_;
  std::vector<BusFrame> taken_;
  std::int64_t num_taken_ = 0;
  std::int64_t num_given_ = 0;
};

}  // namespace simulator
