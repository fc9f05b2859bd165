// SPDX-License-Identifier: BSD-3-Clause
// A CAN interface of the kernel (can0, vcan0) as the plant's bus. Error frames are heard as well.
// An interface that goes down or away is only counted: the plant goes on without it.
#pragma once

#include <string>

#include "simulator/plant/frame_gateway.h"

namespace simulator {

class SocketCanPort : public FrameGateway {
 public:
  /// Throws DoorError.
  explicit SocketCanPort(const std::string& interface);
  ~SocketCanPort() override;
  SocketCanPort(const SocketCanPort&) = delete;
  SocketCanPort& operator=(const SocketCanPort&) = delete;

  void add_to_poll(std::vector<pollfd>& descriptors) const override;
  void receive(std::vector<BusFrame>& frames) override;
  void send(const BusFrame& frame) override;
  std::int64_t num_lost() const override { return num_lost_; }

 private:
  int descriptor_ = -1;
  std::int64_t num_lost_ = 0;
};

}  // namespace simulator
