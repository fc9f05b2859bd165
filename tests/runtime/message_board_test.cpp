// SPDX-License-Identifier: BSD-3-Clause
#include "runtime/message_board.h"

#include <gtest/gtest.h>

#include "runtime/bus.h"

namespace {

using runtime::BoardReader;
using runtime::Heard;
using runtime::MessageBoard;

const runtime::ChannelInfo& channel(const char* name) {
  return *runtime::find_channel(name);
}

void post(MessageBoard& board, const char* name, std::uint8_t content, std::int8_t sender = 0) {
  const std::vector<std::uint8_t> bytes{content};
  board.post({channel(name), sender, bytes}, 0);
}

int next(BoardReader& reader, std::int64_t now_us = 0) {
  const auto posted = reader.next(now_us);
  return posted == nullptr ? -1 : posted->bytes.front();
}

// An empty board, and one that was cleared, have nothing for anyone.
TEST(MessageBoardTest, Empty) {
  MessageBoard board;
  BoardReader reader(board);
  EXPECT_EQ(next(reader), -1);
  post(board, "LADDER_RUNGS", 1);
  board.clear();
  EXPECT_EQ(next(reader), -1);
  post(board, "LADDER_RUNGS", 2);
  EXPECT_EQ(next(reader), 2);
}

// A slow reader gets the newest of a stream, once, and what it missed is counted.
TEST(MessageBoardTest, NewestWins) {
  MessageBoard board;
  BoardReader reader(board);
  for (std::uint8_t i = 1; i <= 5; ++i) post(board, "LADDER_RUNGS", i);
  EXPECT_EQ(next(reader), 5);
  EXPECT_EQ(next(reader), -1);
  EXPECT_EQ(reader.num_missed(), 4);
}

// Every event is kept, in order, up to the board's bound; beyond it the oldest go.
TEST(MessageBoardTest, EventsAreKept) {
  MessageBoard board;
  BoardReader reader(board);
  for (std::uint8_t i = 1; i <= 3; ++i) post(board, "LADDER_EVENT", i);
  EXPECT_EQ(next(reader), 1);
  for (std::size_t i = 0; i < MessageBoard::kKeptEvents; ++i) post(board, "LADDER_EVENT", 7);
  EXPECT_EQ(next(reader), 7);
  EXPECT_EQ(reader.num_missed(), 2);
  for (std::size_t i = 1; i < MessageBoard::kKeptEvents; ++i) EXPECT_EQ(next(reader), 7);
  EXPECT_EQ(next(reader), -1);
}

// Senders on a shared channel do not replace each other.
TEST(MessageBoardTest, OneStreamPerSender) {
  MessageBoard board;
  BoardReader reader(board);
  post(board, "LADDER_HEALTH", 1, 1);
  post(board, "LADDER_HEALTH", 2, 2);
  post(board, "LADDER_HEALTH", 3, 1);
  EXPECT_EQ(next(reader), 3);
  EXPECT_EQ(next(reader), 2);
  EXPECT_EQ(next(reader), -1);
}

// A stream that always has news does not starve the others.
TEST(MessageBoardTest, StreamsTakeTurns) {
  MessageBoard board;
  BoardReader reader(board);
  post(board, "LADDER_RUNGS", 1);
  post(board, "LADDER_CLIMB", 2);
  EXPECT_EQ(next(reader), 1);
  post(board, "LADDER_RUNGS", 3);
  EXPECT_EQ(next(reader), 2);
  EXPECT_EQ(next(reader), 3);
}

// A stream with a shortest period waits for it and then gives the newest.
TEST(MessageBoardTest, Periods) {
  MessageBoard board;
  BoardReader::Periods periods{};
  periods[static_cast<std::size_t>(channel("LADDER_TOF_0").number)] = 200'000;
  BoardReader reader(board, periods);
  post(board, "LADDER_TOF_0", 1);
  EXPECT_EQ(next(reader, 1'000'000), 1);
  post(board, "LADDER_TOF_0", 2);
  post(board, "LADDER_TOF_0", 3);
  EXPECT_EQ(next(reader, 1'199'999), -1);
  EXPECT_EQ(next(reader, 1'200'000), 3);
}

// What a reader holds stays as it was, whatever is posted meanwhile; a late reader gets the state.
TEST(MessageBoardTest, ReadersAreIndependent) {
  MessageBoard board;
  BoardReader early(board);
  post(board, "LADDER_RUNGS", 1);
  const auto held = early.next(0);
  post(board, "LADDER_RUNGS", 2);
  EXPECT_EQ(held->bytes.front(), 1);
  BoardReader late(board);
  EXPECT_EQ(next(late), 2);
  EXPECT_EQ(late.num_missed(), 0);
  EXPECT_EQ(next(early), 2);
}

// The tap hands on the very bytes of sound messages with their sender, and counts the others.
TEST(TapTest, SoundMessagesOnly) {
  const auto connection = runtime::open_lcm("memq://");
  const std::vector<const runtime::ChannelInfo*> channels{&channel("LADDER_EVENT")};
  std::vector<std::vector<std::uint8_t>> heard;
  std::int8_t sender = 0;
  runtime::Tap tap(connection, channels, [&](const Heard& message) {
    heard.emplace_back(message.bytes.begin(), message.bytes.end());
    sender = message.sender;
  });
  tap.drain();
  ladder_msgs::event_t event{};
  event.utime = 5;
  event.level = event.LEVEL_INFO;
  event.service = ladder_msgs::health_t::SERVICE_GNG;
  event.text = "started";
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(event.getEncodedSize()));
  event.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  const auto publish = [&](const char* name, std::size_t num_bytes) {
    lcm_publish(connection.get(), name, bytes.data(), static_cast<unsigned int>(num_bytes));
  };
  publish("LADDER_EVENT", bytes.size());
  publish("LADDER_EVENT", bytes.size() - 1);
  publish("LADDER_EVENT", 0);
  publish("LADDER_RUNGS", bytes.size());  // not asked for
  bytes[25] = 100;                        // no such service
  publish("LADDER_EVENT", bytes.size());
  tap.drain();
  ASSERT_EQ(heard.size(), 1U);
  EXPECT_EQ(heard.front().size(), bytes.size());
  EXPECT_EQ(sender, ladder_msgs::health_t::SERVICE_GNG);
  EXPECT_EQ(tap.received(), 4);
  EXPECT_EQ(tap.rejected(), 3);
}

// Each channel of the contract is checked as its own type: another channel's message is refused.
TEST(MessageCheckTest, EveryChannelKnowsItsType) {
  runtime::MessageCheck check;
  for (const runtime::ChannelInfo& own : runtime::kChannels) {
    for (const runtime::ChannelInfo& other : runtime::kChannels) {
      std::vector<std::uint8_t> bytes(8);
      for (std::size_t i = 0; i < 8; ++i)
        bytes[i] = static_cast<std::uint8_t>(other.type->fingerprint >> (56 - 8 * i));
      const bool is_same = own.type == other.type;
      EXPECT_EQ(check.check(bytes, own),
                is_same ? runtime::Reject::kSize : runtime::Reject::kFingerprint)
          << own.name << " " << other.name;
    }
  }
}

}  // namespace
