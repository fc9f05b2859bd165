// SPDX-License-Identifier: BSD-3-Clause
// What the web server and its sessions share: what is served, and to whom.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "runtime/message_board.h"
#include "viewer/page.h"

namespace viewer {

class WebSocketSession;

/// Outlives every session.
struct ServerContext {
  Page page;
  std::string token;  ///< "" = none is asked for
  const runtime::MessageBoard& board;
  /// One line of JSON about the viewer itself, for a page that missed so many messages.
  std::function<std::string(std::int64_t num_missed)> status;
  /// A page's word to the log player. Empty where messages are live: then a page that says anything
  /// is cut off.
  std::function<void(std::string_view)> on_order = nullptr;
  /// Set by the server: takes a session in, or says that there are too many.
  std::function<bool(const std::shared_ptr<WebSocketSession>&)> admit = nullptr;
};

/// One of the connections that may be open at a time; free again when its last holder lets go.
using ConnectionSlot = std::shared_ptr<void>;

}  // namespace viewer
