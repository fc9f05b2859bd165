// SPDX-License-Identifier: BSD-3-Clause
// The door: takes connections in, never more than it has places for and not faster than a person's
// browser comes; the rest waits in the kernel's short queue.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

#include "viewer/exhibition.h"
#include "viewer/visit.h"

namespace viewer {

class WebServer {
 public:
  static constexpr int kMaxConnections = 64;  ///< pages that watch included
  static constexpr int kMaxWatchers = 16;

  /// Listens at once; throws boost::system::system_error where the address cannot be had.
  WebServer(boost::asio::io_context& io, const boost::asio::ip::tcp::endpoint& address,
            Exhibition exhibition);

  /// Tells every page what is new on the board.
  void show_news();

  int num_watchers() const;
  std::uint16_t port() const { return acceptor_.local_endpoint().port(); }

 private:
  void accept_later();
  void accept();
  bool admit(const std::shared_ptr<Watcher>& watcher);

  Exhibition exhibition_;
  Reception reception_;
  boost::asio::ip::tcp::acceptor acceptor_;
  boost::asio::steady_timer pause_;
  std::shared_ptr<int> num_places_taken_ = std::make_shared<int>(0);
  std::vector<std::weak_ptr<Watcher>> watchers_;
};

}  // namespace viewer
