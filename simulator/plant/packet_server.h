// SPDX-License-Identifier: BSD-3-Clause
// Small packets of one fixed size between a listening SOCK_SEQPACKET socket and its clients. Takes
// whoever comes, forgets whoever goes, never blocks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <poll.h>

namespace simulator {

class PacketServer {
 public:
  using Bytes = std::span<const std::byte>;

  /// "" = no listening socket. A dead socket file is replaced, a living one is a DoorError.
  PacketServer(const std::string& path, std::size_t packet_size);
  ~PacketServer();
  PacketServer(const PacketServer&) = delete;
  PacketServer& operator=(const PacketServer&) = delete;

  void add_client(int descriptor);
  int num_clients() const { return static_cast<int>(clients_.size()); }
  void add_to_poll(std::vector<pollfd>& descriptors) const;

  /// Accepts, then hands over each packet with the client it came from; packets of another size are
  /// counted and dropped. `greet` is called for each new client.
  void receive(const std::function<void(int client, Bytes)>& take,
               const std::function<void(int client)>& greet = {});
  /// To all clients, or all but one.
  void broadcast(Bytes packet, int except = -1);
  void send_to(int client, Bytes packet);

  std::int64_t num_lost() const { return num_lost_; }
  std::int64_t num_malformed() const { return num_malformed_; }

 private:
  void accept_all(const std::function<void(int)>& greet);
  /// False when the client is gone.
  bool drain(int client, const std::function<void(int, Bytes)>& take);

  std::string path_;
  std::size_t packet_size_;
  int listener_ = -1;
  std::vector<int> clients_;
  std::int64_t num_lost_ = 0;
  std::int64_t num_malformed_ = 0;
};

}  // namespace simulator
