// SPDX-License-Identifier: BSD-3-Clause
#include "runtime/message_board.h"

#include <algorithm>

namespace runtime {
namespace {

std::size_t depth_of(const ChannelInfo& channel) {
  using Health = ladder_msgs::health_t;
  if (channel.number == Health::CHANNEL_EVENT) return MessageBoard::kKeptEvents;
  if (channel.number == Health::CHANNEL_COMMAND) return MessageBoard::kKeptOrders;
  return 1;
}

}  // namespace

MessageBoard::Stream& MessageBoard::stream_of(const Heard& heard) {
  const auto found = std::find_if(streams_.begin(), streams_.end(), [&](const Stream& stream) {
    return stream.channel == &heard.channel && stream.sender == heard.sender;
  });
  if (found != streams_.end()) return *found;
  return streams_.emplace_back(Stream{&heard.channel, heard.sender, 0, {}});
}

void MessageBoard::post(const Heard& heard, std::int64_t received_utime_us) {
  Stream& stream = stream_of(heard);
  stream.kept.push_back(std::make_shared<const Posted>(
      Posted{&heard.channel, received_utime_us, {heard.bytes.begin(), heard.bytes.end()}}));
  ++stream.num_posted;
  if (stream.kept.size() > depth_of(heard.channel)) stream.kept.pop_front();
}

void MessageBoard::clear() {
  for (Stream& stream : streams_) stream.kept.clear();
}

BoardReader::BoardReader(const MessageBoard& board, const Periods& periods_us)
    : board_(board), periods_us_(periods_us) {
  for (const MessageBoard::Stream& stream : board.streams_)
    progress_.push_back({stream.oldest(), 0});
}

std::shared_ptr<const Posted> BoardReader::next(std::int64_t monotonic_us) {
  const std::size_t num_streams = board_.streams_.size();
  progress_.resize(num_streams);
  for (std::size_t i = 0; i < num_streams; ++i) {
    const std::size_t at = (turn_ + i) % num_streams;
    const MessageBoard::Stream& stream = board_.streams_[at];
    Progress& progress = progress_[at];
    const std::int64_t oldest = stream.oldest();
    if (progress.num_seen < oldest) {
      num_missed_ += oldest - progress.num_seen;
      progress.num_seen = oldest;
    }
    if (progress.num_seen == stream.num_posted || monotonic_us < progress.due_us) continue;
    turn_ = at + 1;
    progress.due_us = monotonic_us + periods_us_[static_cast<std::size_t>(stream.channel->number)];
    return stream.kept[static_cast<std::size_t>(progress.num_seen++ - oldest)];
  }
  return nullptr;
}

}  // namespace runtime
