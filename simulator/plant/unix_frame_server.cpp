// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/plant/unix_frame_server.h"

#include <cstring>

#include <linux/can.h>

namespace simulator {

UnixFrameServer::UnixFrameServer(const std::string& path) : server_(path, sizeof(::can_frame)) {}

void UnixFrameServer::add_to_poll(std::vector<pollfd>& descriptors) const {
  server_.add_to_poll(descriptors);
}

void UnixFrameServer::receive(std::vector<BusFrame>& frames) {
  server_.receive([this, &frames](int client, PacketServer::Bytes packet) {
    ::can_frame frame{};
    std::memcpy(&frame, packet.data(), sizeof frame);
    frames.push_back(from_kernel(frame));
    server_.broadcast(packet, client);
  });
}

void UnixFrameServer::send(const BusFrame& frame) {
  const ::can_frame kernel = to_kernel(frame);
  server_.broadcast(std::as_bytes(std::span(&kernel, 1)));
}

}  // namespace simulator
