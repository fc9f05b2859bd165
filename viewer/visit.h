// SPDX-License-Identifier: BSD-3-Clause
// One HTTP request: a file of the page, or the door to the messages (a WebSocket on /messages).
// Answered once, then the connection ends, so that whoever comes often has to queue for each visit.
#pragma once

#include <functional>
#include <memory>

#include <boost/asio/ip/tcp.hpp>

#include "viewer/exhibition.h"

namespace viewer {

class Watcher;

struct Reception {
  const Exhibition& exhibition;
  /// Takes the watcher in, or says that the audience is full.
  std::function<bool(const std::shared_ptr<Watcher>&)> admit;
};

/// Goes on by itself until the answer is sent, at most ten seconds.
void receive_visit(boost::asio::ip::tcp::socket&& socket, const Reception& reception, Place place);

}  // namespace viewer
