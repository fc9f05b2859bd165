// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/web_socket_session.h"

#include "runtime/clock.h"

namespace viewer {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using std::chrono::seconds;

constexpr std::int64_t kStatusPeriodUs = 1'000'000;
constexpr std::int64_t kImagePeriodUs = 200'000;   // four depth images: 1.5 MB a second
constexpr std::int64_t kPicturePeriodUs = 45'000;  // what the scene is drawn from: 20 Hz
constexpr seconds kHandshakePatience{5};
constexpr seconds kSilencePatience{20};  // half of it, then a ping; without an answer: cut off

runtime::BoardReader::Periods page_periods() {
  using Health = ladder_msgs::health_t;
  runtime::BoardReader::Periods periods_us{};
  for (int number = Health::CHANNEL_TOF_0; number <= Health::CHANNEL_TOF_3; ++number) {
    periods_us[static_cast<std::size_t>(number)] = kImagePeriodUs;
  }
  for (const std::int16_t number : {Health::CHANNEL_POSE, Health::CHANNEL_TOPOLOGY,
                                    Health::CHANNEL_RUNGS, Health::CHANNEL_CLIMB}) {
    periods_us[static_cast<std::size_t>(number)] = kPicturePeriodUs;
  }
  return periods_us;
}

void put_big_endian(std::uint64_t value, std::size_t num_bytes, std::uint8_t* to) {
  for (std::size_t i = 0; i < num_bytes; ++i) {
    to[i] = static_cast<std::uint8_t>(value >> (8 * (num_bytes - 1 - i)));
  }
}

}  // namespace

WebSocketSession::WebSocketSession(beast::tcp_stream&& stream, const ServerContext& context,
                                   ConnectionSlot slot)
    : socket_(std::move(stream)),
      context_(context),
      slot_(std::move(slot)),
      reader_(context.board, page_periods()) {}

void WebSocketSession::open(const Request& request) {
  beast::get_lowest_layer(socket_).expires_never();  // the WebSocket has its own timeouts
  socket_.set_option(websocket::stream_base::timeout{kHandshakePatience, kSilencePatience, true});
  socket_.read_message_max(kMaxOrderBytes);
  socket_.async_accept(request, [self = shared_from_this()](beast::error_code error) {
    if (error) return;
    self->is_ready_ = true;
    self->read();
    self->send_newest();
  });
}

void WebSocketSession::read() {
  socket_.async_read(heard_, [self = shared_from_this()](beast::error_code error, std::size_t) {
    self->on_read(error);
  });
}

void WebSocketSession::on_read(beast::error_code error) {
  if (error || !socket_.got_text() || !context_.on_order) return close();
  const auto text = heard_.cdata();
  context_.on_order({static_cast<const char*>(text.data()), text.size()});
  heard_.clear();
  read();
}

void WebSocketSession::send_newest() {
  if (!is_ready_) return;
  const std::int64_t now_us = runtime::clock_now().monotonic_us;
  if (now_us >= status_due_us_) {
    status_due_us_ = now_us + kStatusPeriodUs;
    send_status();
  } else if (auto posted = reader_.next(now_us)) {
    send(std::move(posted));
  }
}

void WebSocketSession::send_status() {
  is_ready_ = false;
  status_ = context_.status(reader_.num_missed());
  socket_.text(true);
  socket_.async_write(asio::buffer(status_),
                      [self = shared_from_this()](beast::error_code error, std::size_t) {
                        if (!error) self->on_written();
                      });
}

void WebSocketSession::send(std::shared_ptr<const runtime::Posted> posted) {
  is_ready_ = false;
  sending_ = std::move(posted);
  put_big_endian(static_cast<std::uint64_t>(sending_->received_utime_us), 8, head_.data());
  put_big_endian(static_cast<std::uint16_t>(sending_->channel->number), 2, head_.data() + 8);
  const std::array<asio::const_buffer, 2> frame{asio::buffer(head_), asio::buffer(sending_->bytes)};
  socket_.binary(true);
  socket_.async_write(frame, [self = shared_from_this()](beast::error_code error, std::size_t) {
    if (!error) self->on_written();
  });
}

void WebSocketSession::on_written() {
  sending_.reset();
  is_ready_ = true;
  send_newest();
}

void WebSocketSession::close() {
  is_ready_ = false;
  beast::get_lowest_layer(socket_).close();
}

}  // namespace viewer
