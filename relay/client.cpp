// SPDX-License-Identifier: BSD-3-Clause
#include "relay/client.h"

#include <chrono>

namespace relay {
namespace {

constexpr std::chrono::seconds kConnectPeriod{1};

}  // namespace

Client::Client(boost::asio::io_context& io, std::string host, std::string port, std::string token,
               Endpoint& endpoint)
    : io_(io),
      pause_(io),
      host_(std::move(host)),
      port_(std::move(port)),
      token_(std::move(token)),
      endpoint_(endpoint) {
  connect_when_needed();
}

Client::~Client() {
  if (const auto connection = connection_.lock()) connection->close();
}

void Client::connect_when_needed() {
  if (!is_connected() && handshake_.expired()) {
    handshake_ = connect(io_, host_, port_, token_, [this](boost::asio::ip::tcp::socket&& socket) {
      connection_ = start_connection(std::move(socket), endpoint_);
    });
  }
  pause_.expires_after(kConnectPeriod);
  pause_.async_wait([this](boost::system::error_code error) {
    if (!error) connect_when_needed();
  });
}

void Client::send_newest() {
  if (const auto connection = connection_.lock()) connection->send_newest();
}

}  // namespace relay
