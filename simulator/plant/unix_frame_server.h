// SPDX-License-Identifier: BSD-3-Clause
// A CAN bus without a kernel's CAN: a SOCK_SEQPACKET server at a path. Each packet is one struct
// can_frame (16 bytes); every client hears the plant and all other clients, never itself.
#pragma once

#include <string>
#include <vector>

#include "simulator/plant/frame_gateway.h"
#include "simulator/plant/packet_server.h"

namespace simulator {

class UnixFrameServer : public FrameGateway {
 public:
  /// Listens at the path; "" = none, for clients given by add_client(). Throws DoorError.
  explicit UnixFrameServer(const std::string& path);

  /// Takes over one end of a socketpair.
  void add_client(int descriptor) { server_.add_client(descriptor); }
  int num_clients() const { return server_.num_clients(); }

  void add_to_poll(std::vector<pollfd>& descriptors) const override;
  void receive(std::vector<BusFrame>& frames) override;
  void send(const BusFrame& frame) override;
  std::int64_t num_lost() const override { return server_.num_lost(); }

 private:
  PacketServer server_;
};

}  // namespace simulator
