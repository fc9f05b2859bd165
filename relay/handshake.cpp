// SPDX-License-Identifier: BSD-3-Clause
#include "relay/handshake.h"

#include <chrono>

#include <boost/asio/connect.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>

#include "runtime/token.h"

namespace relay {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

constexpr std::chrono::seconds kPatience{4};

std::string word_with(const std::string& token) {
  return "LADDER-RELAY 1 " + token + "\n";
}

/// What both sides have: a socket, and an end to patience.
class Handshake : public std::enable_shared_from_this<Handshake> {
 public:
  Handshake(tcp::socket&& socket, const std::string& token, Accepted accepted)
      : socket_(std::move(socket)),
        resolver_(socket_.get_executor()),
        patience_(socket_.get_executor()),
        wanted_(word_with(token)),
        accepted_(std::move(accepted)) {}

  void await() {
    be_patient();
    said_.resize(wanted_.size());
    asio::async_read(socket_, asio::buffer(said_),
                     [self = shared_from_this()](error_code error, std::size_t) {
                       self->end(!error && runtime::is_same_token(self->said_, self->wanted_));
                     });
  }

  void resolve(const std::string& host, const std::string& port) {
    be_patient();
    resolver_.async_resolve(
        host, port,
        [self = shared_from_this()](error_code error, const tcp::resolver::results_type& found) {
          error ? self->end(false) : self->connect(found);
        });
  }

 private:
  void connect(const tcp::resolver::results_type& found) {
    asio::async_connect(socket_, found,
                        [self = shared_from_this()](error_code error, const tcp::endpoint&) {
                          error ? self->end(false) : self->say();
                        });
  }

  void say() {
    asio::async_write(
        socket_, asio::buffer(wanted_),
        [self = shared_from_this()](error_code error, std::size_t) { self->end(!error); });
  }

  void be_patient() {
    patience_.expires_after(kPatience);
    patience_.async_wait([self = shared_from_this()](error_code error) {
      if (error) return;
      error_code ignored;
      self->resolver_.cancel();
      self->socket_.close(ignored);
    });
  }

  void end(bool is_agreed) {
    patience_.cancel();
    if (is_agreed && socket_.is_open()) accepted_(std::move(socket_));
  }

  tcp::socket socket_;
  tcp::resolver resolver_;
  asio::steady_timer patience_;
  std::string wanted_, said_;
  Accepted accepted_;
};

}  // namespace

Ongoing accept_handshake(tcp::socket&& socket, const std::string& token, Accepted accepted) {
  const auto handshake = std::make_shared<Handshake>(std::move(socket), token, std::move(accepted));
  handshake->await();
  return handshake;
}

Ongoing connect(asio::io_context& io, const std::string& host, const std::string& port,
                const std::string& token, Accepted accepted) {
  const auto handshake = std::make_shared<Handshake>(tcp::socket(io), token, std::move(accepted));
  handshake->resolve(host, port);
  return handshake;
}

}  // namespace relay
