// SPDX-License-Identifier: BSD-3-Clause
#include "relay/connection.h"

#include <chrono>

#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>

#include "runtime/clock.h"

namespace relay {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;

constexpr std::chrono::seconds kLookPeriod{1};
constexpr int kMaxSilentLooks = 5;

}  // namespace

Connection::Connection(asio::ip::tcp::socket&& socket, Endpoint& endpoint)
    : socket_(std::move(socket)),
      watch_(socket_.get_executor()),
      endpoint_(endpoint),
      reader_(endpoint.board()) {}

void Connection::start() {
  error_code ignored;
  socket_.set_option(asio::ip::tcp::no_delay(true), ignored);
  read_head();
  watch();
  send_newest();
}

void Connection::read_head() {
  asio::async_read(
      socket_, asio::buffer(head_in_), [self = shared_from_this()](error_code error, std::size_t) {
        if (error) return self->close();
        self->was_heard_ = true;
        const auto& head = self->head_in_;
        const std::size_t num_bytes = std::size_t{head[0]} << 24 | std::size_t{head[1]} << 16 |
                                      std::size_t{head[2]} << 8 | std::size_t{head[3]};
        const auto number = static_cast<std::int16_t>(head[4] << 8 | head[5]);
        if (num_bytes == 0 && number == 0) return self->read_head();
        const runtime::ChannelInfo* channel = self->endpoint_.find_received(number);
        if (channel == nullptr || num_bytes > channel->type->max_bytes) return self->close();
        self->read_message(*channel, num_bytes);
      });
}

void Connection::read_message(const runtime::ChannelInfo& channel, std::size_t num_bytes) {
  message_in_.resize(num_bytes);
  asio::async_read(socket_, asio::buffer(message_in_),
                   [self = shared_from_this(), &channel](error_code error, std::size_t) {
                     if (error) return self->close();
                     self->was_heard_ = true;
                     self->endpoint_.publish(channel, self->message_in_);
                     self->read_head();
                   });
}

void Connection::send_newest() {
  if (is_writing_ || !socket_.is_open()) return;
  if (auto posted = reader_.next(runtime::clock_now().monotonic_us)) write(std::move(posted));
}

void Connection::write(std::shared_ptr<const runtime::Posted> posted) {
  is_writing_ = true;
  message_out_ = std::move(posted);
  const auto number = static_cast<std::uint16_t>(message_out_ ? message_out_->channel->number : 0);
  const std::size_t num_bytes = message_out_ ? message_out_->bytes.size() : 0;
  for (std::size_t i = 0; i < 4; ++i) {
    head_out_[i] = static_cast<std::uint8_t>(num_bytes >> (24 - 8 * i));
  }
  head_out_[4] = static_cast<std::uint8_t>(number >> 8);
  head_out_[5] = static_cast<std::uint8_t>(number);
  std::array<asio::const_buffer, 2> parts{asio::buffer(head_out_), asio::const_buffer()};
  if (message_out_) parts[1] = asio::buffer(message_out_->bytes);
  asio::async_write(socket_, parts, [self = shared_from_this()](error_code error, std::size_t) {
    if (error) return self->close();
    self->is_writing_ = false;
    self->send_newest();
  });
}

void Connection::watch() {
  num_silent_looks_ = was_heard_ ? 0 : num_silent_looks_ + 1;
  was_heard_ = false;
  if (num_silent_looks_ >= kMaxSilentLooks) return close();
  if (!is_writing_) write(nullptr);
  watch_.expires_after(kLookPeriod);
  watch_.async_wait([self = shared_from_this()](error_code error) {
    if (!error && self->socket_.is_open()) self->watch();
  });
}

void Connection::close() {
  error_code ignored;
  socket_.close(ignored);
  watch_.cancel();
}

std::shared_ptr<Connection> start_connection(asio::ip::tcp::socket&& socket, Endpoint& endpoint) {
  const auto connection = std::make_shared<Connection>(std::move(socket), endpoint);
  connection->start();
  return connection;
}

}  // namespace relay
