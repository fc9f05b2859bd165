// SPDX-License-Identifier: BSD-3-Clause
#include "relay/ends.h"

#include <chrono>

namespace relay {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;
using namespace std::chrono_literals;

constexpr auto kAcceptPause = 50ms;
constexpr auto kConnectPeriod = 1s;

template <class Weak>
void forget_ended(std::vector<Weak>& all) {
  std::erase_if(all, [](const Weak& each) { return each.expired(); });
}

std::shared_ptr<Line> start_line(tcp::socket&& socket, Traffic& traffic) {
  const auto line = std::make_shared<Line>(std::move(socket), traffic);
  line->start();
  return line;
}

}  // namespace

ServingEnd::ServingEnd(asio::io_context& io, const tcp::endpoint& address, std::string token,
                       Traffic& traffic)
    : acceptor_(io, address), pause_(io), token_(std::move(token)), traffic_(traffic) {
  accept();
}

ServingEnd::~ServingEnd() {
  for (const auto& each : lines_) {
    if (const auto line = each.lock()) line->close();
  }
}

void ServingEnd::accept_later() {
  pause_.expires_after(kAcceptPause);
  pause_.async_wait([this](error_code error) {
    if (!error) accept();
  });
}

void ServingEnd::accept() {
  forget_ended(greetings_);
  if (num_lines() >= kMaxLines || greetings_.size() >= kMaxGreetings) return accept_later();
  acceptor_.async_accept([this](error_code error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    if (!error) {
      greetings_.push_back(await_greeting(std::move(socket), token_, [this](tcp::socket&& greeted) {
        lines_.emplace_back(start_line(std::move(greeted), traffic_));
      }));
    }
    accept_later();
  });
}

void ServingEnd::send_news() {
  forget_ended(lines_);
  for (const auto& each : lines_) {
    if (const auto line = each.lock()) line->send_news();
  }
}

int ServingEnd::num_lines() const {
  int number = 0;
  for (const auto& line : lines_) number += line.expired() ? 0 : 1;
  return number;
}

ConnectingEnd::ConnectingEnd(asio::io_context& io, std::string host, std::string port,
                             std::string token, Traffic& traffic)
    : io_(io),
      pause_(io),
      host_(std::move(host)),
      port_(std::move(port)),
      token_(std::move(token)),
      traffic_(traffic) {
  connect_when_needed();
}

ConnectingEnd::~ConnectingEnd() {
  if (const auto line = line_.lock()) line->close();
}

void ConnectingEnd::connect_when_needed() {
  if (!is_connected() && greeting_.expired()) {
    greeting_ = greet(io_, host_, port_, token_, [this](tcp::socket&& socket) {
      line_ = start_line(std::move(socket), traffic_);
    });
  }
  pause_.expires_after(kConnectPeriod);
  pause_.async_wait([this](error_code error) {
    if (!error) connect_when_needed();
  });
}

void ConnectingEnd::send_news() {
  if (const auto line = line_.lock()) line->send_news();
}

}  // namespace relay
