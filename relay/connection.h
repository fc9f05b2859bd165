// SPDX-License-Identifier: BSD-3-Clause
// One TCP connection between the two ends. One message is on its way at a time; what it cannot
// carry in time is replaced by newer messages (runtime/message_board.h), so a slow network costs
// rate and never memory. An end that is silent for five seconds is given up.
//
// On the wire, big-endian: uint32 length of the message, int16 channel number (health_t CHANNEL_*),
// the LCM message. Length 0 and number 0: nothing, but the sender lives.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

#include "relay/endpoint.h"

namespace relay {

class Connection : public std::enable_shared_from_this<Connection> {
 public:
  static constexpr std::size_t kHeadBytes = 6;

  Connection(boost::asio::ip::tcp::socket&& socket, Endpoint& endpoint);

  /// Reads and writes until either end closes.
  void start();
  /// Sends what is new, if nothing is on its way.
  void send_newest();
  void close();

 private:
  void read_head();
  void read_message(const runtime::ChannelInfo& channel, std::size_t num_bytes);
  void write(std::shared_ptr<const runtime::Posted> posted);
  void watch();

  boost::asio::ip::tcp::socket socket_;
  boost::asio::steady_timer watch_;
  Endpoint& endpoint_;
  runtime::BoardReader reader_;
  std::array<std::uint8_t, kHeadBytes> head_in_{}, head_out_{};
  std::vector<std::uint8_t> message_in_;
  std::shared_ptr<const runtime::Posted> message_out_;  ///< on its way
  bool is_writing_ = false;
  bool was_heard_ = true;  ///< since the watch looked last
  int num_silent_looks_ = 0;
};

/// One that has started.
std::shared_ptr<Connection> start_connection(boost::asio::ip::tcp::socket&& socket,
                                             Endpoint& endpoint);

}  // namespace relay
