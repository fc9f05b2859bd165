// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/plant/packet_server.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "base/check.h"
#include "simulator/plant/frame_gateway.h"

namespace simulator {
namespace {

constexpr int kBacklog = 8;
constexpr std::size_t kMaxPacket = 72;

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw DoorError("cannot listen at " + path + ": " + what);
}

sockaddr_un address_of(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) refuse(path, "the path is too long");
  std::copy(path.begin(), path.end(), address.sun_path);
  return address;
}

/// Does somebody listen there?
bool is_alive(const sockaddr_un& address) {
  const int probe = ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
  if (probe < 0) return false;
  const bool alive =
      ::connect(probe, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  ::close(probe);
  return alive;
}

int listen_at(const std::string& path) {
  const sockaddr_un address = address_of(path);
  if (is_alive(address)) refuse(path, "another plant listens there already");
  ::unlink(path.c_str());
  const int listener = ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (listener < 0) refuse(path, std::strerror(errno));
  const bool bound =
      ::bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  if (!bound || ::listen(listener, kBacklog) != 0) {
    const std::string reason = std::strerror(errno);
    ::close(listener);
    refuse(path, reason);
  }
  return listener;
}

}  // namespace

PacketServer::PacketServer(const std::string& path, std::size_t packet_size)
    : path_(path), packet_size_(packet_size) {
  CHECK(packet_size <= kMaxPacket, "packets are small");
  if (!path_.empty()) listener_ = listen_at(path_);
}

PacketServer::~PacketServer() {
  for (const int client : clients_) ::close(client);
  if (listener_ < 0) return;
  ::close(listener_);
  ::unlink(path_.c_str());
}

void PacketServer::add_client(int descriptor) {
  ::fcntl(descriptor, F_SETFL, ::fcntl(descriptor, F_GETFL) | O_NONBLOCK);
  clients_.push_back(descriptor);
}

void PacketServer::add_to_poll(std::vector<pollfd>& descriptors) const {
  if (listener_ >= 0) descriptors.push_back({listener_, POLLIN, 0});
  for (const int client : clients_) descriptors.push_back({client, POLLIN, 0});
}

void PacketServer::accept_all(const std::function<void(int)>& greet) {
  while (listener_ >= 0) {
    const int client = ::accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (client < 0) return;
    clients_.push_back(client);
    if (greet) greet(client);
  }
}

void PacketServer::receive(const std::function<void(int, Bytes)>& take,
                           const std::function<void(int)>& greet) {
  accept_all(greet);
  for (std::size_t i = 0; i < clients_.size();) {
    const int client = clients_[i];
    if (drain(client, take)) {
      ++i;
      continue;
    }
    ::close(client);
    clients_.erase(clients_.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

bool PacketServer::drain(int client, const std::function<void(int, Bytes)>& take) {
  std::array<std::byte, kMaxPacket + 1> buffer{};
  while (true) {
    const ssize_t size = ::recv(client, buffer.data(), buffer.size(), MSG_DONTWAIT);
    if (size == 0) return false;
    if (size < 0) return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
    if (static_cast<std::size_t>(size) != packet_size_) {
      ++num_malformed_;
      continue;
    }
    take(client, {buffer.data(), packet_size_});
  }
}

void PacketServer::broadcast(Bytes packet, int except) {
  for (const int client : clients_) {
    if (client != except) send_to(client, packet);
  }
}

void PacketServer::send_to(int client, Bytes packet) {
  const ssize_t sent = ::send(client, packet.data(), packet.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  if (sent != static_cast<ssize_t>(packet.size())) ++num_lost_;
}

}  // namespace simulator
