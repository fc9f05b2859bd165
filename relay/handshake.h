// SPDX-License-Identifier: BSD-3-Clause
// How a connection begins: the end that comes says "LADDER-RELAY 1 TOKEN" and a newline; the other
// one lets it in only then. Both give up after a few seconds.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>

namespace relay {

using Accepted = std::function<void(boost::asio::ip::tcp::socket&&)>;

/// Alive as long as a handshake is under way.
using Ongoing = std::weak_ptr<void>;

/// Waits for the word of whoever has come; on any other one, or none, the connection ends.
Ongoing accept_handshake(boost::asio::ip::tcp::socket&& socket, const std::string& token,
                         Accepted accepted);

/// Connects and says the word; when it cannot, nothing more happens.
Ongoing connect(boost::asio::io_context& io, const std::string& host, const std::string& port,
                const std::string& token, Accepted accepted);

}  // namespace relay
