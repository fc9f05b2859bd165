// SPDX-License-Identifier: BSD-3-Clause
// Plays a log onto the message board in the log's own time: play, pause, seek, faster and slower.
// Nothing of it goes to LCM.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "runtime/message_board.h"
#include "runtime/message_check.h"
#include "viewer/log_file.h"

namespace viewer {

class LogPlayer {
 public:
  static constexpr double kMaxSpeed = 16.0;

  /// Begins to play at the first step().
  LogPlayer(const std::string& path, runtime::MessageBoard& board);

  /// Posts what is due by now.
  void step(std::int64_t monotonic_us);

  /// "play", "pause", "seek S" (seconds from the start), "speed X"; anything else changes nothing.
  void obey(std::string_view order);

  /// Members of a JSON object: where it is.
  std::string status() const;

 private:
  void play_until(std::int64_t utime_us);
  void seek(std::int64_t utime_us);

  LogFile log_;
  runtime::MessageBoard& board_;
  runtime::MessageCheck check_;
  const LogEvent* waiting_;  ///< not due yet; nullptr at the end
  std::int64_t at_us_;       ///< log time
  std::int64_t last_step_us_ = -1;
  double speed_ = 1.0;
  bool is_playing_ = true;
  std::int64_t num_seeks_ = 0;  ///< a page forgets its curves when this changes
};

}  // namespace viewer
