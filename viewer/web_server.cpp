// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/web_server.h"

#include <algorithm>
#include <chrono>

#include "viewer/watcher.h"

namespace viewer {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;

constexpr std::chrono::milliseconds kPause{10};  // 100 connections a second: a page needs four
constexpr int kWaitingInKernel = 32;

Place take_place(const std::shared_ptr<int>& num_taken) {
  ++*num_taken;
  return {nullptr, [num_taken](void*) { --*num_taken; }};
}

}  // namespace

WebServer::WebServer(asio::io_context& io, const tcp::endpoint& address, Exhibition exhibition)
    : exhibition_(std::move(exhibition)),
      reception_{exhibition_, [this](const auto& watcher) { return admit(watcher); }},
      acceptor_(io),
      pause_(io) {
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
  if (*num_places_taken_ >= kMaxConnections) return accept_later();
  acceptor_.async_accept([this](boost::system::error_code error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    if (!error) receive_visit(std::move(socket), reception_, take_place(num_places_taken_));
    accept_later();
  });
}

bool WebServer::admit(const std::shared_ptr<Watcher>& watcher) {
  if (num_watchers() >= kMaxWatchers) return false;
  watchers_.push_back(watcher);
  return true;
}

void WebServer::show_news() {
  std::erase_if(watchers_, [](const auto& watcher) { return watcher.expired(); });
  for (const auto& each : watchers_) {
    if (const auto watcher = each.lock()) watcher->show_news();
  }
}

int WebServer::num_watchers() const {
  return static_cast<int>(std::count_if(watchers_.begin(), watchers_.end(),
                                        [](const auto& watcher) { return !watcher.expired(); }));
}

}  // namespace viewer
