// SPDX-License-Identifier: BSD-3-Clause
// The end that connects, on the ground, and connects again whenever the connection breaks.
#pragma once

#include <memory>
#include <string>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

#include "relay/connection.h"
#include "relay/handshake.h"

namespace relay {

class Client {
 public:
  Client(boost::asio::io_context& io, std::string host, std::string port, std::string token,
         Endpoint& endpoint);
  ~Client();  ///< closes its connection
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  void send_newest();
  bool is_connected() const { return !connection_.expired(); }

 private:
  void connect_when_needed();

  boost::asio::io_context& io_;
  boost::asio::steady_timer pause_;
  std::string host_, port_, token_;
  Endpoint& endpoint_;
  Ongoing handshake_;
  std::weak_ptr<Connection> connection_;
};

}  // namespace relay
