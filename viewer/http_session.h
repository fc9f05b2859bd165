// SPDX-License-Identifier: BSD-3-Clause
// One HTTP request: a file of the page, or the door to the messages (a WebSocket on /messages).
// Answered once, then the connection ends: who asks often waits at the door each time.
#pragma once

#include <boost/asio/ip/tcp.hpp>

#include "viewer/server_context.h"

namespace viewer {

/// Goes on by itself until the answer is sent, at most ten seconds.
void serve_http(boost::asio::ip::tcp::socket&& socket, const ServerContext& context,
                ConnectionSlot slot);

}  // namespace viewer
