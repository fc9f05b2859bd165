// SPDX-License-Identifier: BSD-3-Clause
// One page's WebSocket. It gets messages as binary frames and once a second the
// viewer's status as a text frame. There is one frame on its way at a time and no queue: a slow
// page gets the newest when it is ready (runtime/message_board.h).
//
// A binary frame, big-endian: int64 when it was heard [us since the epoch], int16 channel number
// (health_t CHANNEL_*), then the LCM message as it was on the bus.
#pragma once

#include <array>
#include <chrono>
#include <memory>
#include <string>

#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include "viewer/server_context.h"

namespace viewer {

class WebSocketSession : public std::enable_shared_from_this<WebSocketSession> {
 public:
  using Request = boost::beast::http::request<boost::beast::http::empty_body>;

  static constexpr std::size_t kMaxOrderBytes = 64;
  static constexpr std::size_t kFrameHeadBytes = 10;

  WebSocketSession(boost::beast::tcp_stream&& stream, const ServerContext& context,
                   ConnectionSlot slot);

  /// Answers the handshake; frames follow.
  void open(const Request& request);

  /// Sends what there is, if the page is ready for it.
  void send_newest();

 private:
  void read();
  void on_read(boost::beast::error_code error);
  void send_status();
  void send(std::shared_ptr<const runtime::Posted> posted);
  void on_written();
  void close();

  boost::beast::websocket::stream<boost::beast::tcp_stream> socket_;
  const ServerContext& context_;
  ConnectionSlot slot_;
  runtime::BoardReader reader_;
  boost::beast::flat_static_buffer<kMaxOrderBytes> heard_;
  std::shared_ptr<const runtime::Posted> sending_;  ///< on its way
  std::array<std::uint8_t, kFrameHeadBytes> head_{};
  std::string status_;
  std::int64_t status_due_us_ = 0;
  bool is_ready_ = false;
};

}  // namespace viewer
