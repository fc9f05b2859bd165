// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/log_player.h"

#include <fstream>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "ladder_msgs/imu_t.hpp"

namespace {

using viewer::LogFile;
using viewer::LogPlayer;

constexpr std::int64_t kStartUs = 1'700'000'000'000'000;

std::string big_endian(std::uint64_t value, int num_bytes) {
  std::string bytes;
  for (int i = num_bytes - 1; i >= 0; --i) bytes += static_cast<char>(value >> (8 * i));
  return bytes;
}

std::string event(std::int64_t utime_us, const std::string& channel, const std::string& message) {
  return big_endian(0xEDA1DA01, 4) + big_endian(0, 8) +
         big_endian(static_cast<std::uint64_t>(utime_us), 8) + big_endian(channel.size(), 4) +
         big_endian(message.size(), 4) + channel + message;
}

std::string imu_event(std::int64_t after_us, std::int64_t seq) {
  ladder_msgs::imu_t message{};
  message.utime = kStartUs + after_us;
  message.seq = seq;
  std::string bytes(static_cast<std::size_t>(message.getEncodedSize()), '\0');
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return event(kStartUs + after_us, "LADDER_IMU", bytes);
}

class LogTest : public ::testing::Test {
 protected:
  const std::string& write(const std::string& content) {
    std::ofstream(path_, std::ios::binary) << content;
    return path_;
  }
  void TearDown() override { unlink(path_.c_str()); }

  /// seq of the newest message on the board, -1 for none.
  std::int64_t newest(runtime::BoardReader& reader) {
    std::int64_t seq = -1;
    while (const auto posted = reader.next(0)) seq = posted->bytes[23];
    return seq;
  }

  std::string path_ = "/tmp/ladder-viewer-test-" + std::to_string(getpid()) + ".lcm";
};

/// 20 s, ten messages a second, seq 0 .. 199.
std::string long_log() {
  std::string log;
  for (int i = 0; i < 200; ++i) log += imu_event(100'000L * i, i);
  return log;
}

// No file, an empty one and one that is no log are refused with the name.
TEST_F(LogTest, NotALog) {
  EXPECT_THROW(LogFile("/no/such.lcm"), std::runtime_error);
  EXPECT_THROW(LogFile(write("")), std::runtime_error);
  EXPECT_THROW(LogFile(write(std::string(1000, 'x'))), std::runtime_error);
}

// Every event comes once and as written; then nothing more.
TEST_F(LogTest, ReadsEveryEvent) {
  LogFile log(write(event(5, "A", "first") + event(7, "", "") + event(6, "B", "third")));
  EXPECT_EQ(log.start_us(), 5);
  EXPECT_EQ(log.end_us(), 7);
  EXPECT_FALSE(log.is_damaged());
  const std::string first(reinterpret_cast<const char*>(log.next()->bytes.data()), 5);
  EXPECT_EQ(first, "first");
  EXPECT_EQ(log.next()->channel, "");
  EXPECT_EQ(log.next()->channel, "B");
  EXPECT_EQ(log.next(), nullptr);
  EXPECT_EQ(log.next(), nullptr);
}

// Damage ends the log where it begins, whatever the damaged lengths say: cut short, lengths beyond
// the file or beyond reason, another magic number.
TEST_F(LogTest, EndsAtDamage) {
  const std::string whole = event(5, "A", "first");
  const std::string next = event(6, "B", "second");
  std::string other_magic = next, long_channel = next, long_message = next;
  other_magic[0] = 'x';
  long_channel.replace(20, 4, "\xff\xff\xff\xff");
  long_message.replace(24, 4, std::string("\x7f\xff\xff\xff"));
  for (const std::string& damaged : {next.substr(0, next.size() - 1), next.substr(0, 10),
                                     other_magic, long_channel, long_message}) {
    LogFile log(write(whole + damaged));
    EXPECT_TRUE(log.is_damaged());
    EXPECT_NE(log.next(), nullptr);
    EXPECT_EQ(log.next(), nullptr);
    log.seek(100);
    EXPECT_NE(log.next(), nullptr);
  }
}

// After seek the next event is at most half a second before the wanted time, or the first.
TEST_F(LogTest, Seek) {
  LogFile log(write(long_log()));
  for (const std::int64_t wanted_us :
       {std::int64_t{0}, kStartUs, kStartUs + 12'340'000, kStartUs + 19'900'000,
        std::numeric_limits<std::int64_t>::max()}) {
    log.seek(wanted_us);
    const std::int64_t found_us = log.next()->utime_us;
    EXPECT_TRUE(found_us <= wanted_us || found_us == kStartUs);
    EXPECT_GE(found_us, std::min(wanted_us, log.end_us()) - 500'000);
  }
}

// The log's own time passes with the clock: what is due is posted, no more; speed multiplies it,
// a pause stops it, and a process that was held up does not run after lost seconds.
TEST_F(LogTest, PlaysInTime) {
  runtime::MessageBoard board;
  runtime::BoardReader reader(board);
  LogPlayer player(write(long_log()), board);
  std::int64_t now_us = 1000;
  const auto pass = [&](int num_steps, std::int64_t step_us) {
    for (int i = 0; i < num_steps; ++i) player.step(now_us += step_us);
    return newest(reader);
  };
  player.step(now_us);
  EXPECT_EQ(pass(10, 100'000), 10);
  player.obey("speed 4");
  EXPECT_EQ(pass(10, 50'000), 30);
  player.obey("pause");
  EXPECT_EQ(pass(10, 100'000), -1);
  player.obey("speed 1");
  player.obey("play");
  EXPECT_EQ(pass(1, 60'000'000), 32);
  EXPECT_EQ(pass(1000, 100'000), 199);
  EXPECT_EQ(pass(10, 100'000), -1);
}

// A seek shows the state at that place at once, forwards, backwards, and playing or not.
TEST_F(LogTest, SeekShowsTheState) {
  runtime::MessageBoard board;
  runtime::BoardReader reader(board);
  LogPlayer player(write(long_log()), board);
  player.obey("pause");
  player.obey("seek 15");
  EXPECT_EQ(newest(reader), 150);
  player.obey("seek 3");
  EXPECT_EQ(newest(reader), 30);
  player.obey("seek 1e6");
  EXPECT_EQ(newest(reader), 199);
  EXPECT_THAT(player.status(), ::testing::HasSubstr(R"("seeks":3)"));
}

// Orders that are none change nothing.
TEST_F(LogTest, NonsenseOrders) {
  runtime::MessageBoard board;
  LogPlayer player(write(long_log()), board);
  const std::string before = player.status();
  for (const char* order :
       {"", "seek", "seek ", "seek x", "seek -1", "seek nan", "seek inf", "seek 1e99", "seek 3 ",
        "speed 0", "speed -2", "speed 1e9", "speed nan", "PLAY", "play ", "arm"}) {
    player.obey(order);
    EXPECT_EQ(player.status(), before) << order;
  }
}

// Messages that no service would accept, and channels that are not ours, are passed over.
TEST_F(LogTest, UnsoundMessages) {
  runtime::MessageBoard board;
  runtime::BoardReader reader(board);
  LogPlayer player(write(event(kStartUs, "LADDER_IMU", "nonsense") +
                         event(kStartUs, "OTHER", "nonsense") + imu_event(1000, 5)),
                   board);
  player.obey("seek 1");
  EXPECT_EQ(newest(reader), 5);
  EXPECT_EQ(reader.num_missed(), 0);
}

}  // namespace
