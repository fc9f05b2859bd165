// SPDX-License-Identifier: BSD-3-Clause
// What a person should know: to standard error and, where a bus is given, as event_t. The same text
// is not repeated within five seconds.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include "ladder_msgs/event_t.hpp"

namespace runtime {

class Journal {
 public:
  using Sink = std::function<void(const ladder_msgs::event_t&)>;

  /// service: health_t SERVICE_*; name: how it is called in the log lines.
  Journal(std::int8_t service, std::string name) : service_(service), name_(std::move(name)) {}

  void publish_to(Sink sink) { sink_ = std::move(sink); }
  /// Lines below this level (event_t LEVEL_*) are not written to standard error.
  void show_from(std::int8_t level) { shown_level_ = level; }

  void info(const std::string& text) { write(ladder_msgs::event_t::LEVEL_INFO, text); }
  void warning(const std::string& text) { write(ladder_msgs::event_t::LEVEL_WARNING, text); }
  void error(const std::string& text) { write(ladder_msgs::event_t::LEVEL_ERROR, text); }

 private:
  void write(std::int8_t level, const std::string& text);

  std::int8_t service_;
  std::string name_;
  Sink sink_;
  std::int8_t shown_level_ = ladder_msgs::event_t::LEVEL_INFO;
  std::int64_t seq_ = 0;
  std::map<std::string, std::int64_t> last_written_us_;  ///< by text, bounded
};

}  // namespace runtime
