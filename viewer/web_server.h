// SPDX-License-Identifier: BSD-3-Clause
// Accepts connections, never more than a fixed number at a time and not faster than a person's
// browser comes; the rest waits in the kernel's short queue.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

#include "viewer/server_context.h"

namespace viewer {

class WebServer {
 public:
  static constexpr int kMaxConnections = 64;  ///< WebSockets included
  static constexpr int kMaxWebSockets = 16;

  /// Listens at once; throws boost::system::system_error where the address cannot be had.
  WebServer(boost::asio::io_context& io, const boost::asio::ip::tcp::endpoint& address,
            ServerContext context);

  /// Sends every page that is ready what is new on the board.
  void send_newest();

  int num_web_sockets() const;
  std::uint16_t port() const { return acceptor_.local_endpoint().port(); }

 private:
  void accept_later();
  void accept();
  bool admit(const std::shared_ptr<WebSocketSession>& session);

  ServerContext context_;
  boost::asio::ip::tcp::acceptor acceptor_;
  boost::asio::steady_timer pause_;
  std::shared_ptr<int> num_connections_ = std::make_shared<int>(0);
  std::vector<std::weak_ptr<WebSocketSession>> web_sockets_;
};

}  // namespace viewer
