// SPDX-License-Identifier: BSD-3-Clause
// What the web server and its connections share: what there is to see and who may see it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "runtime/message_board.h"
#include "viewer/page.h"

namespace viewer {

/// What is served, and to whom; outlives every connection.
struct Exhibition {
  Page page;
  std::string token;  ///< "" = none is asked for
  const runtime::MessageBoard& board;
  /// One line of JSON about the viewer itself, for a page that missed so many messages.
  std::function<std::string(std::int64_t num_missed)> status;
  /// A page's word to the log player. Empty where messages are live: then a page that says anything
  /// is cut off.
  std::function<void(std::string_view)> on_order;
};

/// One place in the audience; free again when its last holder lets go.
using Place = std::shared_ptr<void>;

}  // namespace viewer
