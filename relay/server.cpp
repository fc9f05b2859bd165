// SPDX-License-Identifier: BSD-3-Clause
#include "relay/server.h"

#include <chrono>

namespace relay {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;
using namespace std::chrono_literals;

constexpr auto kAcceptPause = 50ms;

template <class Weak>
void forget_ended(std::vector<Weak>& all) {
  std::erase_if(all, [](const Weak& each) { return each.expired(); });
}

}  // namespace

Server::Server(asio::io_context& io, const tcp::endpoint& address, std::string token,
               Endpoint& endpoint)
    : acceptor_(io, address), pause_(io), token_(std::move(token)), endpoint_(endpoint) {
  accept();
}

Server::~Server() {
  for (const auto& each : connections_) {
    if (const auto connection = each.lock()) connection->close();
  }
}

void Server::accept_later() {
  pause_.expires_after(kAcceptPause);
  pause_.async_wait([this](error_code error) {
    if (!error) accept();
  });
}

void Server::accept() {
  forget_ended(handshakes_);
  if (num_connections() >= kMaxConnections || handshakes_.size() >= kMaxHandshakes)
    return accept_later();
  acceptor_.async_accept([this](error_code error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    if (!error) {
      handshakes_.push_back(
          accept_handshake(std::move(socket), token_, [this](tcp::socket&& accepted) {
            connections_.emplace_back(start_connection(std::move(accepted), endpoint_));
          }));
    }
    accept_later();
  });
}

void Server::send_newest() {
  forget_ended(connections_);
  for (const auto& each : connections_) {
    if (const auto connection = each.lock()) connection->send_newest();
  }
}

int Server::num_connections() const {
  int number = 0;
  for (const auto& connection : connections_) number += connection.expired() ? 0 : 1;
  return number;
}

}  // namespace relay
