// SPDX-License-Identifier: BSD-3-Clause
// A door of the in-memory bus to other processes: a socket that carries one struct can_frame per
// packet, or a CAN interface of the kernel. Nothing here blocks.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <poll.h>

#include "simulator/plant/bus_frame.h"

struct can_frame;

namespace simulator {

/// A door cannot be opened: what, and how to mend it.
struct DoorError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

BusFrame from_kernel(const ::can_frame& frame);
::can_frame to_kernel(const BusFrame& frame);

class FrameGateway {
 public:
  virtual ~FrameGateway() = default;
  /// Appends what should wake the process.
  virtual void add_to_poll(std::vector<pollfd>& descriptors) const = 0;
  /// Appends every frame that has arrived.
  virtual void receive(std::vector<BusFrame>& frames) = 0;
  /// Now or never: a peer that does not read loses frames (counted).
  virtual void send(const BusFrame& frame) = 0;
  virtual std::int64_t num_lost() const = 0;
};

/// "unix:PATH" or the name of a CAN interface. Throws DoorError.
std::unique_ptr<FrameGateway> open_gateway(const std::string& interface);

}  // namespace simulator
