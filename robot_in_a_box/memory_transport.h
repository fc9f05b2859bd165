// SPDX-License-Identifier: BSD-3-Clause
// The controller's CAN transport on the plant's in-memory bus, in virtual time.
#pragma once

#include "can/transport.h"
#include "simulator/plant/memory_bus.h"

namespace robot_in_a_box {

class MemoryTransport : public can::Transport {
 public:
  explicit MemoryTransport(simulator::MemoryBus& bus) : bus_(bus), port_(bus.attach()) {}

  /// The time of what is sent and received from now on.
  void set_time(std::int64_t now_us) { now_us_ = now_us; }
  int port() const { return port_; }

  can::TransferStatus send(const can::CanFrame& frame) override {
    simulator::BusFrame sent;
    sent.id = frame.id | (frame.extended ? simulator::kExtendedFlag : 0U) |
              (frame.remote ? simulator::kRemoteFlag : 0U);
    sent.length = frame.dlc;
    sent.bytes = frame.data;
    switch (bus_.send(port_, sent, now_us_)) {
      case simulator::SendResult::kSent:
        return can::TransferStatus::kDone;
      case simulator::SendResult::kNoBuffers:
        return can::TransferStatus::kNoBuffers;
      case simulator::SendResult::kDown:
        break;
    }
    return can::TransferStatus::kNetworkDown;
  }

  can::TransferStatus receive(can::ReceivedFrame& received) override {
    simulator::CarriedFrame carried;
    if (!bus_.receive(port_, now_us_, carried)) return can::TransferStatus::kWouldBlock;
    received = {};
    received.frame.id = carried.frame.id & 0x1FFFFFFFU;
    received.frame.extended = (carried.frame.id & simulator::kExtendedFlag) != 0;
    received.frame.remote = (carried.frame.id & simulator::kRemoteFlag) != 0;
    received.frame.error = (carried.frame.id & simulator::kErrorFlag) != 0;
    received.frame.dlc = carried.frame.length;
    received.frame.data = carried.frame.bytes;
    return can::TransferStatus::kDone;
  }

  bool has_unsent_frames() const override { return bus_.num_waiting(port_) > 0; }
  bool maintain(std::int64_t now_us) override {
    now_us_ = now_us;
    return bus_.condition() != simulator::BusCondition::kDown;
  }
  can::PurgeResult purge_transmit_queue() override {
    bus_.purge(port_);
    return can::PurgeResult::kPurged;
  }

 private:
  simulator::MemoryBus& bus_;
  int port_;
  std::int64_t now_us_ = 0;
};

}  // namespace robot_in_a_box
