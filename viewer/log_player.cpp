// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/log_player.h"

#include <algorithm>
#include <charconv>
#include <optional>

namespace viewer {
namespace {

constexpr std::int64_t kRunUpUs = 1'500'000;  // what a page should see at once: also health
constexpr std::int64_t kMaxStepUs = 200'000;  // after a pause of the process itself

/// The number behind "name ", or nothing.
std::optional<double> argument(std::string_view order, std::string_view name) {
  if (!order.starts_with(name)) return std::nullopt;
  double value = 0.0;
  const char* end = order.data() + order.size();
  const auto [rest, error] = std::from_chars(order.data() + name.size(), end, value);
  return error == std::errc() && rest == end ? std::optional(value) : std::nullopt;
}

}  // namespace

LogPlayer::LogPlayer(const std::string& path, runtime::MessageBoard& board)
    : log_(path), board_(board), waiting_(log_.next()), at_us_(log_.start_us()) {}

void LogPlayer::step(std::int64_t monotonic_us) {
  const std::int64_t passed_us = std::min(monotonic_us - last_step_us_, kMaxStepUs);
  const bool is_first = last_step_us_ < 0;
  last_step_us_ = monotonic_us;
  if (!is_playing_ || is_first) return;
  play_until(at_us_ + static_cast<std::int64_t>(static_cast<double>(passed_us) * speed_));
}

void LogPlayer::play_until(std::int64_t utime_us) {
  at_us_ = std::min(utime_us, log_.end_us());
  while (waiting_ != nullptr && waiting_->utime_us <= at_us_) {
    const runtime::ChannelInfo* channel = runtime::find_channel(waiting_->channel);
    if (channel != nullptr && check_.check(waiting_->bytes, *channel) == runtime::Reject::kNone) {
      board_.post({*channel, check_.sender(), waiting_->bytes}, waiting_->utime_us);
    }
    waiting_ = log_.next();
  }
}

void LogPlayer::seek(std::int64_t utime_us) {
  const std::int64_t target_us = std::clamp(utime_us, log_.start_us(), log_.end_us());
  board_.clear();
  log_.seek(target_us - kRunUpUs);
  waiting_ = log_.next();
  play_until(target_us);
  ++num_seeks_;
}

void LogPlayer::obey(std::string_view order) {
  if (order == "play") is_playing_ = true;
  if (order == "pause") is_playing_ = false;
  if (const auto speed = argument(order, "speed "); speed && *speed >= 0.1 && *speed <= kMaxSpeed) {
    speed_ = *speed;
  }
  if (const auto place_s = argument(order, "seek ");
      place_s && *place_s >= 0.0 && *place_s <= 1e7) {
    seek(log_.start_us() + static_cast<std::int64_t>(*place_s * 1e6));
  }
}

std::string LogPlayer::status() const {
  const auto seconds = [&](std::int64_t utime_us) {
    return std::to_string(static_cast<double>(utime_us - log_.start_us()) * 1e-6);
  };
  return R"("log":{"at_s":)" + seconds(at_us_) + R"(,"length_s":)" + seconds(log_.end_us()) +
         R"(,"playing":)" + (is_playing_ ? "true" : "false") + R"(,"speed":)" +
         std::to_string(speed_) + R"(,"seeks":)" + std::to_string(num_seeks_) + R"(,"damaged":)" +
         (log_.is_damaged() ? "true" : "false") + "}";
}

}  // namespace viewer
