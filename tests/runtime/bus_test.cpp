// SPDX-License-Identifier: BSD-3-Clause
#include "runtime/bus.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/health.h"

namespace {

using ladder_msgs::imu_t;
using runtime::InputCounts;
using runtime::Reject;
namespace channels = runtime::channels;

imu_t imu(std::int64_t seq, std::int64_t utime) {
  imu_t message{};
  message.seq = seq;
  message.utime = utime;
  message.accelerometer_m_s2[2] = 9.81;
  return message;
}

/// A sender and a receiver on one in-memory connection.
class BusTest : public ::testing::Test {
 protected:
  void publish_raw(const char* channel, const std::vector<std::uint8_t>& bytes) {
    lcm_publish(connection_.get(), channel, bytes.data(), static_cast<unsigned int>(bytes.size()));
  }
  const InputCounts& counts() const { return bus_.inputs().front()->counts; }

  std::shared_ptr<lcm_t> connection_ = runtime::open_lcm("memq://");
  runtime::Bus bus_{connection_};
};

// Nothing sent: drain returns at once and the mailbox stays empty.
TEST_F(BusTest, Silence) {
  auto& mailbox = bus_.newest(channels::kImu);
  EXPECT_EQ(bus_.drain(), 0);
  EXPECT_EQ(mailbox.take(0), nullptr);
}

// What is published arrives with its content.
TEST_F(BusTest, RoundTrip) {
  auto& mailbox = bus_.newest(channels::kImu);
  bus_.publish(channels::kImu, imu(5, 1'000));
  EXPECT_EQ(bus_.drain(), 1);
  const imu_t* received = mailbox.take(1'500);
  ASSERT_NE(received, nullptr);
  EXPECT_EQ(received->seq, 5);
  EXPECT_DOUBLE_EQ(received->accelerometer_m_s2[2], 9.81);
  EXPECT_EQ(counts().received, 1);
}

// A rejected message is counted by cause, the message before it stays usable, and the next good one
// is taken.
TEST_F(BusTest, MalformedChangesNothing) {
  auto& mailbox = bus_.newest(channels::kImu);
  bus_.publish(channels::kImu, imu(1, 1'000));
  publish_raw("LADDER_IMU", {});
  publish_raw("LADDER_IMU", {1, 2, 3});
  publish_raw("LADDER_IMU", std::vector<std::uint8_t>(64, 0));
  imu_t not_finite = imu(2, 2'000);
  not_finite.gyroscope_rad_s[1] = std::numeric_limits<double>::quiet_NaN();
  bus_.publish(channels::kImu, not_finite);
  bus_.drain();
  EXPECT_EQ(mailbox.take(0)->seq, 1);
  EXPECT_EQ(counts().rejected, 4);
  EXPECT_EQ(bus_.rejected(Reject::kSize), 2);
  EXPECT_EQ(bus_.rejected(Reject::kFingerprint), 1);
  EXPECT_EQ(bus_.rejected(Reject::kValue), 1);
  bus_.publish(channels::kImu, imu(3, 3'000));
  bus_.drain();
  EXPECT_EQ(mailbox.take(0)->seq, 3);
}

// A queue sees every message in order; a mailbox on another bus of the same connection sees the
// newest.
TEST_F(BusTest, QueueAndMailboxSideBySide) {
  runtime::Bus other(connection_);
  auto& queue = bus_.queue(channels::kImu, 8);
  auto& mailbox = other.newest(channels::kImu);
  for (int i = 1; i <= 3; ++i) bus_.publish(channels::kImu, imu(i, 1'000 * i));
  bus_.drain();
  for (int i = 1; i <= 3; ++i) EXPECT_EQ(queue.take(0)->seq, i);
  EXPECT_EQ(mailbox.take(0)->seq, 3);
}

// Health carries the counts of the bus, survives its own guard, and seq advances.
TEST_F(BusTest, HealthReportsCounts) {
  runtime::Health health(ladder_msgs::health_t::SERVICE_GNG);
  bus_.newest(channels::kImu);
  auto& reports = bus_.shared_queue(channels::kHealth, 4);
  bus_.publish(channels::kImu, imu(1, 1'000));
  bus_.publish(channels::kImu, imu(5, 2'000));
  publish_raw("LADDER_IMU", {9});
  bus_.drain();
  health.add_stage_us(1, 250);
  bus_.publish(channels::kHealth, health.snapshot(3'000, bus_));
  bus_.drain();
  const ladder_msgs::health_t* report = reports.take(3'000);
  ASSERT_NE(report, nullptr);
  EXPECT_EQ(report->seq, 0);
  EXPECT_EQ(report->num_inputs, 2);
  EXPECT_EQ(report->input_channel[0], ladder_msgs::health_t::CHANNEL_IMU);
  EXPECT_EQ(report->input_received[0], 3);
  EXPECT_EQ(report->input_lost[0], 3);
  EXPECT_EQ(report->input_overwritten[0], 1);
  EXPECT_EQ(report->rejected_size, 1);
  EXPECT_EQ(report->num_stages, 2);
  EXPECT_EQ(report->stage_p50_us[1], 250);
}

struct OrderCase {
  const char* what;
  runtime::StreamPosition next;
  Reject verdict;
  std::int64_t lost;
  std::int64_t restarts;
};

// The order of a stream, case by case, after a message with seq 10 at 5 s.
TEST(JudgeOrder, Table) {
  constexpr std::int64_t kSecond = 1'000'000;
  const OrderCase cases[] = {
      {"the next one", {5 * kSecond + 1, 11}, Reject::kNone, 0, 0},
      {"two lost", {5 * kSecond + 1, 13}, Reject::kNone, 2, 0},
      {"the same twice", {5 * kSecond, 10}, Reject::kStale, 0, 0},
      {"late by one", {5 * kSecond - 1, 9}, Reject::kStale, 0, 0},
      {"same number, later time", {5 * kSecond + 1, 10}, Reject::kStale, 0, 0},
      {"higher number, earlier time", {5 * kSecond - 1, 11}, Reject::kStale, 0, 0},
      {"sender restarted", {6 * kSecond, 0}, Reject::kNone, 0, 1},
      {"older recording", {2 * kSecond, 700}, Reject::kNone, 0, 1},
  };
  for (const OrderCase& c : cases) {
    InputCounts counts;
    runtime::StreamPosition position;
    ASSERT_EQ(runtime::judge_order({5 * kSecond, 10}, position, counts), Reject::kNone);
    EXPECT_EQ(runtime::judge_order(c.next, position, counts), c.verdict) << c.what;
    EXPECT_EQ(counts.lost, c.lost) << c.what;
    EXPECT_EQ(counts.restarts, c.restarts) << c.what;
  }
}

// The first message is never a loss, whatever its number.
TEST(JudgeOrder, FirstMessageIsNoLoss) {
  InputCounts counts;
  runtime::StreamPosition position;
  EXPECT_EQ(runtime::judge_order({1, 1'000}, position, counts), Reject::kNone);
  EXPECT_EQ(counts.lost, 0);
}

// A URL that cannot be opened is an error that names it.
TEST(OpenLcm, BadUrlNamesIt) {
  try {
    runtime::open_lcm("nonsense://here");
    FAIL() << "opened";
  } catch (const runtime::BusError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("nonsense://here"));
  }
}

// Socket buffers matter for udpm alone; a URL that asks for a small buffer is told the exact fix.
TEST(SocketBuffers, SmallBufferIsNamedWithItsFix) {
  EXPECT_EQ(runtime::socket_buffer_problem("memq://"), "");
  EXPECT_THAT(runtime::socket_buffer_problem("udpm://239.255.76.67:7667?ttl=0&recv_buf_size=1000"),
              ::testing::HasSubstr("sysctl -w net.core.rmem_max"));
}

}  // namespace
