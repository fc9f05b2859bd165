// SPDX-License-Identifier: BSD-3-Clause
// Where messages hang for readers of different speed: of each stream the newest, of the channels
// whose every message counts (events, orders) the last few. Nobody queues: a slow reader finds
// newer messages when it comes back, and memory is bounded whatever readers do.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "runtime/tap.h"

namespace runtime {

/// One message as it hangs on the board; readers share it.
struct Posted {
  const ChannelInfo* channel;
  std::int64_t received_utime_us;
  std::vector<std::uint8_t> bytes;
};

class MessageBoard {
 public:
  static constexpr std::size_t kKeptEvents = 200;
  static constexpr std::size_t kKeptOrders = 16;

  /// received_utime_us: when the message was heard, on the clock of its utime.
  void post(const Heard& heard, std::int64_t received_utime_us);

  /// Forgets every message; readers go on with what comes.
  void clear();

 private:
  friend class BoardReader;

  /// The messages of one sender on one channel.
  struct Stream {
    const ChannelInfo* channel;
    std::int8_t sender;
    std::int64_t num_posted = 0;  ///< the last of `kept` is number num_posted - 1
    std::deque<std::shared_ptr<const Posted>> kept;

    std::int64_t oldest() const { return num_posted - static_cast<std::int64_t>(kept.size()); }
  };

  Stream& stream_of(const Heard& heard);

  std::deque<Stream> streams_;  ///< a handful; their places never change
};

/// What one reader has seen of a board.
class BoardReader {
 public:
  /// Shortest time between two messages of a stream, by channel number (health_t CHANNEL_*).
  using Periods = std::array<std::int64_t, 32>;

  /// Begins with what hangs there now.
  explicit BoardReader(const MessageBoard& board, const Periods& periods_us = {});

  /// The next message that this reader has not seen, the streams taking turns; nullptr when there
  /// is none, or when its stream is not due yet.
  std::shared_ptr<const Posted> next(std::int64_t monotonic_us);

  /// Messages that were replaced before this reader came for them, or before they were due.
  std::int64_t num_missed() const { return num_missed_; }

 private:
  struct Progress {
    std::int64_t num_seen = 0;
    std::int64_t due_us = 0;
  };

  const MessageBoard& board_;
  Periods periods_us_;
  std::vector<Progress> progress_;  ///< by stream
  std::size_t turn_ = 0;
  std::int64_t num_missed_ = 0;
};

}  // namespace runtime
