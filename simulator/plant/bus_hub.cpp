// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/plant/bus_hub.h"

#include <utility>

namespace simulator {

BusHub::BusHub(MemoryBus& bus, std::unique_ptr<FrameGateway> gateway)
    : bus_(bus), port_(bus.attach()), gateway_(std::move(gateway)) {}

void BusHub::take_in(std::int64_t now_us) {
  taken_.clear();
  gateway_->receive(taken_);
  for (const BusFrame& frame : taken_) bus_.send(port_, frame, now_us);
  num_taken_ += static_cast<std::int64_t>(taken_.size());
}

void BusHub::give_out(std::int64_t now_us) {
  for (CarriedFrame carried; bus_.receive(port_, now_us, carried);) {
    gateway_->send(carried.frame);
    ++num_given_;
  }
}

}  // namespace simulator
