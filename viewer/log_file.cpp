// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/log_file.h"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace viewer {
namespace {

constexpr std::uint32_t kMagic = 0xEDA1DA01;
constexpr std::size_t kHeadBytes = 28;  // magic, number, time, lengths of channel and message
constexpr std::size_t kMaxChannelBytes = 63;
constexpr std::size_t kMaxMessageBytes = 64'000'000;
constexpr std::int64_t kMarkPeriodUs = 500'000;

std::uint64_t big_endian(const std::array<char, kHeadBytes>& bytes, std::size_t from,
                         std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = from; i < from + count; ++i) {
    value = value << 8 | static_cast<unsigned char>(bytes[i]);
  }
  return value;
}

}  // namespace

LogFile::LogFile(const std::string& path) : stream_(path, std::ios::binary) {
  stream_.seekg(0, std::ios::end);
  const std::int64_t file_bytes = stream_.tellg();
  stream_.seekg(0);
  while (const auto head = read_head()) {
    const auto content = static_cast<std::int64_t>(head->channel_bytes + head->message_bytes);
    const std::int64_t event_end = whole_bytes_ + static_cast<std::int64_t>(kHeadBytes) + content;
    if (event_end > file_bytes) break;
    if (marks_.empty() || head->utime_us >= marks_.back().utime_us + kMarkPeriodUs) {
      marks_.push_back({head->utime_us, whole_bytes_});
    }
    end_us_ = std::max(end_us_, head->utime_us);
    whole_bytes_ = event_end;
    stream_.seekg(whole_bytes_);
  }
  if (marks_.empty()) throw std::runtime_error(path + " is not an LCM log, or an empty one");
  is_damaged_ = whole_bytes_ < file_bytes;
  stream_.clear();
  stream_.seekg(0);
}

std::optional<LogFile::Head> LogFile::read_head() {
  std::array<char, kHeadBytes> bytes{};
  if (!stream_.read(bytes.data(), bytes.size())) return std::nullopt;
  const Head head{static_cast<std::int64_t>(big_endian(bytes, 12, 8)), big_endian(bytes, 20, 4),
                  big_endian(bytes, 24, 4)};
  const bool is_sound = big_endian(bytes, 0, 4) == kMagic &&
                        head.channel_bytes <= kMaxChannelBytes &&
                        head.message_bytes <= kMaxMessageBytes;
  return is_sound ? std::optional(head) : std::nullopt;
}

const LogEvent* LogFile::next() {
  if (stream_.tellg() >= whole_bytes_) return nullptr;
  const auto head = read_head();
  if (!head) return nullptr;
  event_.utime_us = head->utime_us;
  event_.channel.resize(head->channel_bytes);
  event_.bytes.resize(head->message_bytes);
  stream_.read(event_.channel.data(), static_cast<std::streamsize>(head->channel_bytes));
  stream_.read(reinterpret_cast<char*>(event_.bytes.data()),
               static_cast<std::streamsize>(head->message_bytes));
  return stream_ ? &event_ : nullptr;
}

void LogFile::seek(std::int64_t utime_us) {
  const auto behind = std::upper_bound(
      marks_.begin(), marks_.end(), utime_us,
      [](std::int64_t wanted, const Mark& mark) { return wanted < mark.utime_us; });
  stream_.clear();
  stream_.seekg(behind == marks_.begin() ? 0 : std::prev(behind)->offset);
}

}  // namespace viewer
