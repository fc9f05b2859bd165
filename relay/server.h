// SPDX-License-Identifier: BSD-3-Clause
// The end that waits, on the robot: accepts a few connections after their handshake.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

#include "relay/connection.h"
#include "relay/handshake.h"

namespace relay {

class Server {
 public:
  static constexpr int kMaxConnections = 4;
  static constexpr int kMaxHandshakes = 8;  ///< under way

  /// Listens at once; throws boost::system::system_error where the address cannot be had.
  Server(boost::asio::io_context& io, const boost::asio::ip::tcp::endpoint& address,
         std::string token, Endpoint& endpoint);
  ~Server();  ///< closes its connections
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  void send_newest();
  int num_connections() const;
  std::uint16_t port() const { return acceptor_.local_endpoint().port(); }

 private:
  void accept();
  void accept_later();

  boost::asio::ip::tcp::acceptor acceptor_;
  boost::asio::steady_timer pause_;
  std::string token_;
  Endpoint& endpoint_;
  std::vector<Ongoing> handshakes_;
  std::vector<std::weak_ptr<Connection>> connections_;
};

}  // namespace relay
