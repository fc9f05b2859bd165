// SPDX-License-Identifier: BSD-3-Clause
// An LCM log, read event by event from any place. LCM's own reader believes the lengths that it
// reads and cannot be placed; this one reads no further than the first damage, and says where it
// is (ladder-log repair mends it).
#pragma once

#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

namespace viewer {

struct LogEvent {
  std::int64_t utime_us = 0;  ///< when the message was recorded
  std::string channel;
  std::vector<std::uint8_t> bytes;
};

class LogFile {
 public:
  /// Goes once over the heads of all events. Throws std::runtime_error where there is none.
  explicit LogFile(const std::string& path);

  std::int64_t start_us() const { return marks_.front().utime_us; }
  std::int64_t end_us() const { return end_us_; }
  bool is_damaged() const { return is_damaged_; }

  /// The next event, or nothing at the end (or at the first damage). Valid until the next call.
  const LogEvent* next();

  /// next() goes on at most half a second before `utime_us`, or at the start.
  void seek(std::int64_t utime_us);

 private:
  struct Head {
    std::int64_t utime_us;
    std::size_t channel_bytes, message_bytes;
  };
  /// A place to go to.
  struct Mark {
    std::int64_t utime_us;
    std::int64_t offset;
  };

  std::optional<Head> read_head();

  std::ifstream stream_;
  std::vector<Mark> marks_;
  std::int64_t end_us_ = 0;
  std::int64_t whole_bytes_ = 0;  ///< up to the first damage
  bool is_damaged_ = false;
  LogEvent event_;
};

}  // namespace viewer
