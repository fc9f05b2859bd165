// SPDX-License-Identifier: BSD-3-Clause
#include "runtime/journal.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "runtime/clock.h"

namespace runtime {
namespace {

constexpr std::int64_t kRepeatAfterUs = 5'000'000;
constexpr std::size_t kMaxRemembered = 64;
constexpr std::size_t kMaxTextBytes = 500;  // event_t

spdlog::logger& stderr_log() {
  static const auto log = [] {
    auto made = spdlog::stderr_color_mt("ladder");
    made->set_pattern("%H:%M:%S.%e %^%L%$ %v");
    return made;
  }();
  return *log;
}

spdlog::level::level_enum spdlog_level(std::int8_t level) {
  if (level == ladder_msgs::event_t::LEVEL_ERROR) return spdlog::level::err;
  return level == ladder_msgs::event_t::LEVEL_WARNING ? spdlog::level::warn : spdlog::level::info;
}

}  // namespace

void Journal::write(std::int8_t level, const std::string& text) {
  const base::Now now = clock_now();
  if (last_written_us_.size() >= kMaxRemembered) last_written_us_.clear();
  const auto [entry, is_new] = last_written_us_.try_emplace(text, now.monotonic_us);
  if (!is_new && now.monotonic_us - entry->second < kRepeatAfterUs) return;
  entry->second = now.monotonic_us;
  if (level >= shown_level_) stderr_log().log(spdlog_level(level), "[{}] {}", name_, text);
  if (!sink_) return;
  ladder_msgs::event_t event{};
  event.utime = now.utime_us;
  event.seq = seq_++;
  event.level = level;
  event.service = service_;
  event.text = text.substr(0, kMaxTextBytes);
  sink_(event);
}

}  // namespace runtime
