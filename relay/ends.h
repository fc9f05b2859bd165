// SPDX-License-Identifier: BSD-3-Clause
// The two ends: on the robot one that waits for lines, on the ground one that makes a line and
// makes it again whenever it breaks.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

#include "relay/greeting.h"
#include "relay/line.h"

namespace relay {

class ServingEnd {
 public:
  static constexpr int kMaxLines = 4;
  static constexpr int kMaxGreetings = 8;  ///< connections that have not said the right word yet

  /// Listens at once; throws boost::system::system_error where the address cannot be had.
  ServingEnd(boost::asio::io_context& io, const boost::asio::ip::tcp::endpoint& address,
             std::string token, Traffic& traffic);
  ~ServingEnd();  ///< closes its lines
  ServingEnd(const ServingEnd&) = delete;
  ServingEnd& operator=(const ServingEnd&) = delete;

  void send_news();
  int num_lines() const;
  std::uint16_t port() const { return acceptor_.local_endpoint().port(); }

 private:
  void accept();
  void accept_later();

  boost::asio::ip::tcp::acceptor acceptor_;
  boost::asio::steady_timer pause_;
  std::string token_;
  Traffic& traffic_;
  std::vector<Ongoing> greetings_;
  std::vector<std::weak_ptr<Line>> lines_;
};

class ConnectingEnd {
 public:
  ConnectingEnd(boost::asio::io_context& io, std::string host, std::string port, std::string token,
                Traffic& traffic);
  ~ConnectingEnd();  ///< closes its line
  ConnectingEnd(const ConnectingEnd&) = delete;
  ConnectingEnd& operator=(const ConnectingEnd&) = delete;

  void send_news();
  bool is_connected() const { return !line_.expired(); }

 private:
  void connect_when_needed();

  boost::asio::io_context& io_;
  boost::asio::steady_timer pause_;
  std::string host_, port_, token_;
  Traffic& traffic_;
  Ongoing greeting_;
  std::weak_ptr<Line> line_;
};

}  // namespace relay
