// SPDX-License-Identifier: BSD-3-Clause
// The emission rule as a table: which heads' frames make up which cloud. Times in sixtieths of a
// second, the stagger of four heads at 15 Hz.
#include "tof/head_schedule.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace {

constexpr std::int64_t kStart_us = 1'000'000'000;
constexpr std::int64_t kSlot_us = 16'667;

struct Input {
  int head;
  std::int64_t slot;
  std::int64_t seq;
};

/// Runs the rule as fusion.cpp does. One word per frame: the heads of the clouds due with it,
/// "-" for none, "+" between two; "dup" and "late" for refused frames.
std::vector<std::string> run(tof::HeadSchedule& schedule, const std::vector<Input>& inputs) {
  std::vector<std::string> words;
  for (const Input& input : inputs) {
    std::string word;
    const auto take = [&] {
      if (!word.empty()) word += '+';
      for (int h = 0; h < tof::kNumHeads; ++h) {
        if (schedule.is_waiting(h)) word += static_cast<char>('0' + h);
      }
      schedule.take_all();
    };
    const auto arrival = schedule.arrive(input.head, kStart_us + input.slot * kSlot_us, input.seq);
    if (arrival == tof::Arrival::kAccepted) {
      if (schedule.is_waiting(input.head)) take();
      schedule.put(input.head);
      if (schedule.is_complete()) take();
    } else {
      word = arrival == tof::Arrival::kLate ? "late" : "dup";
    }
    words.push_back(word.empty() ? "-" : word);
  }
  return words;
}

tof::HeadParams awaiting(int num_heads) {
  tof::HeadParams params;
  params.awaited_at_start = num_heads;
  return params;
}

struct Row {
  const char* name;
  std::vector<Input> inputs;
  std::vector<std::string> expected;
};

const Row kTable[] = {
    {"one head alone: every frame is a cloud", {{0, 0, 0}, {0, 4, 1}, {0, 8, 2}}, {"0", "0", "0"}},
    {"four heads: one cloud per round once all are known",
     {{0, 0, 0},
      {1, 1, 0},
      {2, 2, 0},
      {3, 3, 0},
      {0, 4, 1},
      {1, 5, 1},
      {2, 6, 1},
      {3, 7, 1},
      {0, 8, 2}},
     {"0", "-", "-", "-", "0123", "-", "-", "-", "0123"}},
    {"started in the middle of a round: head 0 is awaited, it defines x",
     {{2, 2, 5}, {3, 3, 5}, {0, 4, 5}, {1, 5, 5}},
     {"-", "-", "023", "-"}},
    {"head 0 never comes: a second frame ends the wait",
     {{2, 2, 5}, {3, 3, 5}, {2, 6, 6}, {3, 7, 6}},
     {"-", "-", "23", "23"}},
    {"one frame lost: the round goes out with the others' and misses no turn",
     {{0, 0, 0}, {1, 1, 0}, {0, 4, 1}, {0, 8, 2}, {1, 9, 2}, {0, 12, 3}},
     {"0", "-", "01", "-", "01", "-"}},
    {"a head dies: awaited for three periods, then forgotten",
     {{0, 0, 0}, {1, 1, 0}, {0, 4, 1}, {0, 8, 2}, {0, 12, 3}, {0, 16, 4}, {0, 20, 5}},
     {"0", "-", "01", "-", "0", "0+0", "0"}},
    {"it comes back: awaited again from then on",
     {{0, 0, 0},
      {1, 1, 0},
      {0, 4, 1},
      {0, 40, 10},
      {1, 41, 10},
      {0, 44, 11},
      {0, 48, 12},
      {1, 49, 12}},
     {"0", "-", "01", "0", "-", "01", "-", "01"}},
    {"a frame that waited while its head died is old news",
     {{0, 0, 0}, {1, 1, 0}, {0, 40, 10}},
     {"0", "-", "0"}},
    {"the same frame twice", {{0, 0, 0}, {1, 1, 0}, {1, 1, 0}, {0, 4, 1}}, {"0", "-", "dup", "01"}},
    {"older than the head's newest",
     {{0, 4, 0}, {0, 3, 1}, {0, 4, 2}, {0, 8, 3}},
     {"0", "late", "late", "0"}},
    {"a head's clock far behind all others: its frames are too old to use",
     {{0, 100, 0}, {1, 0, 0}, {0, 104, 1}, {1, 4, 1}, {0, 108, 2}},
     {"0", "late", "0", "late", "0"}},
    {"slightly out of order between heads is no fault",
     {{0, 0, 0}, {1, 1, 0}, {0, 4, 1}, {0, 8, 2}, {1, 5, 1}},
     {"0", "-", "01", "-", "01"}},
    {"a publisher that starts anew counts from zero",
     {{0, 0, 90}, {0, 4, 91}, {0, 30, 0}, {0, 34, 1}},
     {"0", "0", "0", "0"}},
};

// Each row of the table.
TEST(HeadSchedule, EmissionRule) {
  for (const Row& row : kTable) {
    tof::HeadSchedule schedule(awaiting(1));
    EXPECT_EQ(run(schedule, row.inputs), row.expected) << row.name;
  }
}

// Heads that are awaited at the start are in the first cloud; one that never comes holds it up for
// one period only.
TEST(HeadSchedule, TheFirstCloudIsWhole) {
  using Words = std::vector<std::string>;
  tof::HeadSchedule whole(awaiting(4));
  EXPECT_EQ(run(whole, {{0, 0, 0}, {1, 1, 0}, {2, 2, 0}, {3, 3, 0}, {0, 4, 1}}),
            (Words{"-", "-", "-", "0123", "-"}));
  tof::HeadSchedule lacking(awaiting(4));
  EXPECT_EQ(run(lacking, {{0, 0, 0}, {1, 1, 0}, {3, 3, 0}, {0, 4, 1}, {1, 5, 1}, {3, 7, 1}}),
            (Words{"-", "-", "-", "013", "-", "013"}));
  tof::HeadSchedule alone(awaiting(4));
  EXPECT_EQ(run(alone, {{0, 0, 0}, {0, 4, 1}, {0, 8, 2}}), (Words{"-", "0+0", "0"}));
}

// Nothing is due before the first frame, and no head is known.
TEST(HeadSchedule, Empty) {
  tof::HeadSchedule schedule(awaiting(1));
  EXPECT_FALSE(schedule.is_complete());
  for (int h = 0; h < tof::kNumHeads; ++h) {
    EXPECT_EQ(schedule.state(h), tof::HeadState::kUnknown);
  }
}

// Gaps, duplicates and late frames are counted; a corrupt number is not millions of losses.
TEST(HeadSchedule, Counts) {
  tof::HeadSchedule schedule(awaiting(1));
  run(schedule, {{0, 0, 0}, {0, 4, 1}, {0, 16, 4}, {0, 16, 4}, {0, 15, 5}, {0, 20, 5}});
  EXPECT_EQ(schedule.counters(0).accepted, 4);
  EXPECT_EQ(schedule.counters(0).lost, 2);
  EXPECT_EQ(schedule.counters(0).duplicate, 1);
  EXPECT_EQ(schedule.counters(0).late, 1);
  run(schedule, {{0, 24, INT64_MAX}, {0, 28, 0}, {0, 32, INT64_MAX}});
  EXPECT_LE(schedule.counters(0).lost, 2'000'002);
}

// The period of each head is learnt, also through losses; a slow head is not called dead for being
// slow.
TEST(HeadSchedule, PeriodIsMeasuredPerHead) {
  tof::HeadSchedule schedule(awaiting(1));
  std::int64_t seq = 0;
  for (int i = 0; i < 60; ++i) {
    seq += 1 + i % 2;  // every third frame is lost on the way
    run(schedule, {{0, 12 * seq, seq}});
  }
  EXPECT_NEAR(schedule.period_s(0), 0.2, 0.002);
  EXPECT_NEAR(schedule.period_s(1), 1.0 / 15.0, 1e-6);
  run(schedule, {{1, 12 * seq + 30, 0}});
  EXPECT_EQ(schedule.state(0), tof::HeadState::kLive) << "0.5 s of silence at 5 Hz";
  run(schedule, {{1, 12 * seq + 38, 1}});
  EXPECT_EQ(schedule.state(0), tof::HeadState::kDead) << "more than 0.6 s";
  EXPECT_EQ(schedule.state(2), tof::HeadState::kUnknown);
}

// A new recording forgets the heads and keeps the counts.
TEST(HeadSchedule, Reset) {
  tof::HeadSchedule schedule(awaiting(1));
  run(schedule, {{0, 100, 7}, {1, 101, 7}});
  schedule.reset();
  EXPECT_EQ(schedule.state(0), tof::HeadState::kUnknown);
  EXPECT_FALSE(schedule.is_waiting(1));
  EXPECT_EQ(schedule.counters(1).accepted, 1);
  EXPECT_EQ(run(schedule, {{0, 0, 7}}), std::vector<std::string>{"0"});
}

}  // namespace
