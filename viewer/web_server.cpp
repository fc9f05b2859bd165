// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/web_server.h"

#include <algorithm>
#include <chrono>

#include "viewer/http_session.h"
#include "viewer/web_socket_session.h"

namespace viewer {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;

constexpr std::chrono::milliseconds kPause{10};  // 100 connections a second: a page needs four
constexpr int kWaitingInKernel = 32;

ConnectionSlot take_slot(const std::shared_ptr<int>& num_connections) {
  ++*num_connections;
  return {nullptr, [num_connections](void*) { --*num_connections; }};
}

}  // namespace

WebServer::WebServer(asio::io_context& io, const tcp::endpoint& address, ServerContext context)
    : context_(std::move(context)), acceptor_(io), pause_(io) {
  context_.admit = [this](const auto& session) { return admit(session); };
  acceptor_.open(address.protocol());
  acceptor_.set_option(tcp::acceptor::reuse_address(true));
  acceptor_.bind(address);
  acceptor_.listen(kWaitingInKernel);
  accept();
}

void WebServer::accept_later() {
  pause_.expires_after(kPause);
  pause_.async_wait([this](boost::system::error_code error) {
    if (!error) accept();
  });
}

void WebServer::accept() {
  if (*num_connections_ >= kMaxConnections) return accept_later();
  acceptor_.async_accept([this](boost::system::error_code error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    if (!error) serve_http(std::move(socket), context_, take_slot(num_connections_));
    accept_later();
  });
}

bool WebServer::admit(const std::shared_ptr<WebSocketSession>& session) {
  if (num_web_sockets() >= kMaxWebSockets) return false;
  web_sockets_.push_back(session);
  return true;
}

void WebServer::send_newest() {
  std::erase_if(web_sockets_, [](const auto& session) { return session.expired(); });
  for (const auto& each : web_sockets_) {
    if (const auto session = each.lock()) session->send_newest();
  }
}

int WebServer::num_web_sockets() const {
  return static_cast<int>(std::count_if(web_sockets_.begin(), web_sockets_.end(),
                                        [](const auto& session) { return !session.expired(); }));
}

}  // namespace viewer
