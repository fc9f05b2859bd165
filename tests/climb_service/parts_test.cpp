// SPDX-License-Identifier: BSD-3-Clause
// The small parts round the control cycle: slots between threads, the cycle's clock, the meaning of
// bus faults, what perception is believed, conversion to messages, orientation.
#include <cmath>
#include <limits>
#include <thread>

#include <gtest/gtest.h>

#include "climb/attitude.h"
#include "climb_controller/convert.h"
#include "climb_controller/cycle_clock.h"
#include "climb_controller/fault_map.h"
#include "climb_controller/perception_inbox.h"
#include "climb_controller/slots.h"
#include "climb_controller/state_words.h"
#include "runtime/semantic_checks.h"
#include "tests/lcmtypes/sample_messages.h"

namespace climb_controller {
namespace {

using climb::Fault;
using ladder_msgs::climb_state_t;
using ladder_msgs::ladder_t;
using runtime::Reject;

// --- slots ---------------------------------------------------------------------------------------

// Nothing is new before the first value; of several values the newest is read, and only once.
TEST(NewestSlot, NewestWins) {
  NewestSlot<int> slot;
  EXPECT_FALSE(slot.refresh());
  for (const int value : {1, 2, 3}) {
    slot.writing() = value;
    slot.publish();
  }
  EXPECT_TRUE(slot.refresh());
  EXPECT_EQ(slot.newest(), 3);
  EXPECT_FALSE(slot.refresh());
  EXPECT_EQ(slot.newest(), 3);
}

// A reader beside a writer never sees half a value, and never an older one than before.
TEST(NewestSlot, NeverTornBetweenThreads) {
  struct Pair {
    std::array<std::int64_t, 16> values{};
  };
  constexpr std::int64_t kNum = 200'000;
  NewestSlot<Pair> slot;
  std::thread writer([&slot] {
    for (std::int64_t i = 1; i <= kNum; ++i) {
      slot.writing().values.fill(i);
      slot.publish();
    }
  });
  std::int64_t last = 0;
  bool torn = false;
  bool older = false;
  while (last < kNum) {
    if (!slot.refresh()) continue;
    const Pair& pair = slot.newest();
    for (const std::int64_t value : pair.values) torn = torn || value != pair.values[0];
    older = older || pair.values[0] < last;
    last = pair.values[0];
  }
  writer.join();
  EXPECT_FALSE(torn);
  EXPECT_FALSE(older);
}

// A queue keeps order, refuses what finds it full, and goes on afterwards.
TEST(BoundedQueue, KeepsOrderAndRefusesWhenFull) {
  BoundedQueue<int, 3> queue;
  int value = 0;
  EXPECT_FALSE(queue.pop(value));
  for (const int i : {1, 2, 3}) EXPECT_TRUE(queue.push(i));
  EXPECT_FALSE(queue.push(4));
  EXPECT_TRUE(queue.pop(value));
  EXPECT_EQ(value, 1);
  EXPECT_TRUE(queue.push(5));
  for (const int expected : {2, 3, 5}) {
    ASSERT_TRUE(queue.pop(value));
    EXPECT_EQ(value, expected);
  }
  EXPECT_FALSE(queue.pop(value));
}

// --- the cycle's clock ---------------------------------------------------------------------------

// One late cycle is counted; more than three periods late is a fault, of that cycle only.
TEST(CycleClock, CountsOverruns) {
  CycleClock clock({.period_us = 10'000});
  EXPECT_EQ(clock.begin(0, 0), 0U);
  EXPECT_EQ(clock.begin(10'000, 10'000), 0U);
  EXPECT_EQ(clock.begin(35'000, 35'000), 0U);
  EXPECT_EQ(clock.num_overruns(), 1);
  EXPECT_EQ(clock.begin(75'001, 75'001), flag(Fault::kOverrun));
  EXPECT_EQ(clock.begin(85'000, 85'000), 0U);
  EXPECT_EQ(clock.num_overruns(), 2);
  EXPECT_EQ(clock.num_cycles(), 5);
}

// A machine that slept shows by the clock that counts sleep, though no cycle was late.
TEST(CycleClock, SeesSleep) {
  CycleClock clock({.period_us = 10'000});
  clock.begin(0, 5'000'000);
  EXPECT_EQ(clock.begin(10'000, 5'010'000), 0U);
  EXPECT_EQ(clock.begin(20'000, 6'020'000), flag(Fault::kSuspended));
  EXPECT_EQ(clock.begin(30'000, 6'030'000), 0U);
}

// --- faults --------------------------------------------------------------------------------------

// Every cause means a fault of the controller's table, and those of the whole bus silence it or
// are about frames.
TEST(FaultMap, EveryCauseMeansSomething) {
  for (int i = 0; i < can::kNumFaultCauses; ++i) {
    const auto cause = static_cast<can::FaultCause>(i);
    const Fault meaning = meaning_of(cause);
    EXPECT_NE(meaning, Fault::kNone) << can::name(cause);
    const can::Fault fault{cause, 3, 0, 0};
    EXPECT_EQ(flags_of({&fault, 1}), flag(meaning)) << can::name(cause);
  }
  EXPECT_EQ(flags_of({}), 0U);
}

// --- perception ----------------------------------------------------------------------------------

constexpr std::int64_t kWall_us = 1'700'000'000'000'000;

ladder_t rungs_at(std::int64_t utime_us, std::int64_t seq) {
  auto message = lcmtypes::sample<ladder_t>(3, 11);
  message.utime = utime_us;
  message.seq = seq;
  return message;
}

// A sound, fresh message in order is taken with its time of receipt.
TEST(RungsInbox, TakesSoundMessages) {
  RungsInbox inbox({});
  RungsSnapshot snapshot;
  const ladder_t message = rungs_at(kWall_us, 5);
  EXPECT_EQ(inbox.accept(message, {1'000, kWall_us + 100'000}, snapshot), Reject::kNone);
  EXPECT_EQ(snapshot.received_us, 1'000);
  EXPECT_TRUE(snapshot.confirmed);
  ASSERT_EQ(snapshot.rungs.size(), static_cast<std::size_t>(message.num_rungs));
  EXPECT_EQ(snapshot.rungs[1].id, message.rung_id[1]);
  EXPECT_EQ(snapshot.rungs[1].end1_m.z(), static_cast<double>(message.rung_z1_m[1]));
  EXPECT_EQ(snapshot.rungs[1].covariance_m2(0, 2), static_cast<double>(message.rung_cov_xz_m2[1]));
  EXPECT_EQ(snapshot.rungs[1].damaged, message.rung_flags[1] != 0);
  for (const climb::StretchView& stretch : snapshot.stretches) {
    EXPECT_GE(stretch.rung_index, 0);
    EXPECT_LT(stretch.from_m, stretch.to_m);
  }
}

// What is too old, from the future, repeated, reordered or not finite is refused and changes
// nothing.
TEST(RungsInbox, RefusedMessagesChangeNothing) {
  RungsInbox inbox({});
  RungsSnapshot snapshot;
  ASSERT_EQ(inbox.accept(rungs_at(kWall_us, 5), {1'000, kWall_us}, snapshot), Reject::kNone);
  const auto refuse = [&](const ladder_t& message, std::int64_t wall_us) {
    EXPECT_NE(inbox.accept(message, {2'000, wall_us}, snapshot), Reject::kNone);
    EXPECT_EQ(snapshot.received_us, 1'000);
  };
  refuse(rungs_at(kWall_us, 5), kWall_us);                            // the same again
  refuse(rungs_at(kWall_us - 70'000, 4), kWall_us);                   // reordered
  refuse(rungs_at(kWall_us + 60'000, 6), kWall_us + 400'000);         // too old
  refuse(rungs_at(kWall_us + 120'000, 7), kWall_us);                  // from the future
  refuse(rungs_at(kWall_us + 130'000, 8), kWall_us + 3'600'000'000);  // the clock jumped
  ladder_t broken = rungs_at(kWall_us + 140'000, 9);
  broken.rung_x0_m[0] = std::numeric_limits<float>::quiet_NaN();
  refuse(broken, kWall_us + 140'000);
  EXPECT_EQ(inbox.num_refused(), 6);
  EXPECT_EQ(inbox.accept(rungs_at(kWall_us + 150'000, 10), {3'000, kWall_us + 150'000}, snapshot),
            Reject::kNone);
}

// After reserve() the largest message is taken without another byte.
TEST(RungsSnapshot, IsReservedForTheLargestMessage) {
  RungsSnapshot snapshot;
  snapshot.reserve();
  EXPECT_GE(snapshot.rungs.capacity(), static_cast<std::size_t>(ladder_t::MAX_RUNGS));
  EXPECT_GE(snapshot.stretches.capacity(), static_cast<std::size_t>(ladder_t::MAX_INTERVALS));
}

// --- orientation ---------------------------------------------------------------------------------

climb::ImuSample still(std::int64_t utime_us, const Eigen::Vector3d& up_body) {
  return {utime_us, 9.81 * up_body, Eigen::Vector3d::Zero()};
}

// On the ladder the body's x points up, its belly to the ladder: odom's x is where the ladder is,
// its y the robot's left, its z up.
TEST(Attitude, BeginsWithUpAndTheBodysLeft) {
  climb::Attitude attitude({});
  EXPECT_FALSE(attitude.is_known());
  ASSERT_TRUE(attitude.add(still(1'000, Eigen::Vector3d::UnitX())));
  ASSERT_TRUE(attitude.is_known());
  const Eigen::Quaterniond q = attitude.q_odom_body();
  EXPECT_NEAR((q * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitZ()).norm(), 0.0, 1e-12);
  EXPECT_NEAR((q * Eigen::Vector3d::UnitY() - Eigen::Vector3d::UnitY()).norm(), 0.0, 1e-12);
  EXPECT_NEAR((q * -Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitX()).norm(), 0.0, 1e-12);
}

// A slow tilt is followed to its end, also with a gyroscope that says nothing; an hour of gyroscope
// bias turns the heading by nothing.
TEST(Attitude, FollowsTiltWithoutDrift) {
  climb::Attitude attitude({});
  attitude.add(still(0, Eigen::Vector3d::UnitX()));
  const Eigen::Vector3d tilted = Eigen::Vector3d(0.98, 0.0, 0.2).normalized();
  for (int i = 1; i <= 1000; ++i) attitude.add(still(i * 5'000, tilted));
  const Eigen::Vector3d up = attitude.q_odom_body() * tilted;
  EXPECT_NEAR((up - Eigen::Vector3d::UnitZ()).norm(), 0.0, 1e-3);
  const Eigen::Vector3d left_before = attitude.q_odom_body() * Eigen::Vector3d::UnitY();
  for (int i = 1001; i <= 720'000; ++i) {
    climb::ImuSample sample = still(i * 5'000LL, tilted);
    sample.gyroscope_rad_s = {0.01, 0.0, 0.0};
    attitude.add(sample);
  }
  const Eigen::Vector3d left_after = attitude.q_odom_body() * Eigen::Vector3d::UnitY();
  EXPECT_NEAR((left_after - left_before).norm(), 0.0, 0.02);
}

// NaN, a repeated sample and free fall leave the orientation as it was; a long silence begins anew.
TEST(Attitude, OddSamples) {
  climb::Attitude attitude({});
  EXPECT_FALSE(attitude.add(still(1'000, Eigen::Vector3d::Zero())));
  ASSERT_TRUE(attitude.add(still(2'000, Eigen::Vector3d::UnitX())));
  const Eigen::Quaterniond before = attitude.q_odom_body();
  EXPECT_FALSE(attitude.add(still(2'000, Eigen::Vector3d::UnitY())));
  climb::ImuSample broken = still(7'000, Eigen::Vector3d::UnitX());
  broken.gyroscope_rad_s.x() = std::nan("");
  EXPECT_FALSE(attitude.add(broken));
  EXPECT_TRUE(attitude.add(still(12'000, Eigen::Vector3d::Zero())));
  EXPECT_NEAR(attitude.q_odom_body().angularDistance(before), 0.0, 1e-9);
  EXPECT_TRUE(attitude.add(still(5'000'000, Eigen::Vector3d::UnitZ())));
  EXPECT_NEAR((attitude.q_odom_body() * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitZ()).norm(),
              0.0, 1e-9);
}

// --- messages ------------------------------------------------------------------------------------

// A report as it is before anything was heard, with NaN positions, makes a sound message.
TEST(Convert, EmptyReportIsASoundMessage) {
  climb_state_t message{};
  to_message(CycleReport{}, message);
  message.utime = kWall_us;
  message.session_id = 1;
  message.cycle_p50_us = -1;
  EXPECT_EQ(runtime::check_values(message), Reject::kNone);
  EXPECT_EQ(message.state, message.STATE_BOOT);
  EXPECT_EQ(message.reason, message.REASON_NONE);
  EXPECT_EQ(message.estop_active, 1);
  EXPECT_EQ(words::state_and_reason(message), "BOOT");
}

// Every state has a word and is found by it again.
TEST(StateWords, RoundTrip) {
  for (std::int8_t state = climb_state_t::STATE_BOOT; state <= climb_state_t::STATE_DISARMING;
       ++state) {
    EXPECT_EQ(words::state_from(words::state(state)), state);
  }
  EXPECT_FALSE(words::state_from("hold"));
  EXPECT_FALSE(words::state_from(""));
  EXPECT_STREQ(words::state(0), "UNKNOWN");
  EXPECT_STREQ(words::state(100), "UNKNOWN");
}

// A refusal says whose fault it is.
TEST(StateWords, WhyRefused) {
  climb_state_t message{};
  message.order_verdict = message.VERDICT_WRONG_SESSION;
  EXPECT_NE(words::why_refused(message).find("another run"), std::string::npos);
  message.order_verdict = message.VERDICT_NOT_NOW;
  message.state = message.STATE_DISARMED;
  message.policy = message.POLICY_NONE;
  message.reason = message.REASON_NONE;
  EXPECT_EQ(words::why_refused(message), "not in DISARMED");
  message.reason = message.REASON_IMU_SILENT;
  EXPECT_EQ(words::why_refused(message), "IMU silent");
  message.policy = message.POLICY_NO_HOLD_ON_LOSS;
  EXPECT_NE(words::why_refused(message).find("hold by itself"), std::string::npos);
}

}  // namespace
}  // namespace climb_controller
