// SPDX-License-Identifier: BSD-3-Clause
// Lines over a chip of the test's making, in virtual time.
#include "gpio/lines.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "fake_chip.h"

namespace gpio {
namespace {

constexpr std::int64_t kPeriod_us = 10'000;
constexpr LineStates kAssumed{};  ///< what is assumed of lines that cannot be read

struct LinesTest : testing::Test {
  FakeChip chip;
  LinesParams params;
};

// Never opened, never found: E-stop active, no touch, lost, and nothing to wait on.
TEST_F(LinesTest, NeverOpenedIsAStop) {
  chip.refusal = "no such chip";
  Lines lines(params, chip);
  EXPECT_EQ(lines.states(), kAssumed);
  EXPECT_TRUE(kAssumed.estop_active && kAssumed.lost);
  EXPECT_EQ(lines.wake_fd(), -1);
  EXPECT_EQ(lines.open(), "no such chip");
  EXPECT_EQ(lines.poll(0), kAssumed);
  EXPECT_EQ(lines.problem(), "no such chip");
  EXPECT_EQ(lines.num_losses(), 0) << "what never was cannot be lost";
}

// The first reading is the truth: no stop is seen at a start without one, nor missed with one.
TEST_F(LinesTest, FirstReadingCounts) {
  for (const bool pressed : {false, true}) {
    chip.press_estop(pressed);
    Lines lines(params, chip);
    ASSERT_EQ(lines.open(), "");
    EXPECT_EQ(lines.poll(0).estop_active, pressed);
    EXPECT_FALSE(lines.states().lost);
    EXPECT_EQ(lines.wake_fd(), 77);
  }
}

// Each wire moves its own state and no other, with either polarity.
TEST_F(LinesTest, EachWireItsOwnState) {
  for (const bool active_low : {false, true}) {
    for (int touched = 0; touched < kNumTouch; ++touched) {
      chip.levels = kAtRest;
      params = {};
      for (int leg = 0; leg < kNumTouch; ++leg) {
        params.touch[leg].active_low = active_low;
        params.touch[leg].bias = active_low ? Bias::kPullUp : Bias::kPullDown;
        chip.levels[leg] = (leg == touched) != active_low;
      }
      Lines lines(params, chip);
      LineStates expected{{}, false, false};
      expected.touch[touched] = true;
      EXPECT_EQ(lines.poll(0), expected) << touched;
    }
  }
}

// Touch passes unfiltered (its filter is elsewhere): open to closed to open, reading by reading.
TEST_F(LinesTest, TouchIsNotFiltered) {
  Lines lines(params, chip);
  for (int i = 0; i < 6; ++i) {
    chip.levels[1] = i % 2 == 1;
    EXPECT_EQ(lines.poll(i).touch[1], i % 2 == 1);
  }
}

// Read every 10 ms and not woken, a press at any microsecond is active within two periods, and
// never before 5 ms; woken by its edge, within 5 ms and one period.
TEST_F(LinesTest, EstopWithinItsBound) {
  std::int64_t worst_us = 0;
  std::int64_t worst_woken_us = 0;
  for (const bool is_woken : {false, true}) {
    for (std::int64_t pressed_us = 1; pressed_us <= kPeriod_us; pressed_us += 3) {
      chip.press_estop(false);
      Lines lines(params, chip);
      lines.poll(0);
      chip.press_estop(true);
      if (is_woken) lines.poll(pressed_us);
      std::int64_t now_us = kPeriod_us;
      while (!lines.poll(now_us).estop_active) now_us += kPeriod_us;
      const std::int64_t taken_us = now_us - pressed_us;
      EXPECT_GE(taken_us, params.estop.debounce_us);
      auto& worst = is_woken ? worst_woken_us : worst_us;
      worst = std::max(worst, taken_us);
    }
  }
  EXPECT_LE(worst_us, 2 * kPeriod_us);
  EXPECT_GT(worst_us, 2 * kPeriod_us - 10) << "the bound is reached";
  EXPECT_LE(worst_woken_us, params.estop.debounce_us + kPeriod_us);
  EXPECT_GT(worst_woken_us, kPeriod_us);
}

// A spike between two readings, or at one of them, is no press; a release bounces as long.
TEST_F(LinesTest, EstopSpikesAndBounces) {
  Lines lines(params, chip);
  lines.poll(0);
  chip.press_estop(true);
  EXPECT_FALSE(lines.poll(1'000).estop_active);
  chip.press_estop(false);
  EXPECT_FALSE(lines.poll(2'000).estop_active);
  EXPECT_FALSE(lines.poll(10'000).estop_active);
  chip.press_estop(true);
  lines.poll(20'000);
  EXPECT_TRUE(lines.poll(25'000).estop_active);
  chip.press_estop(false);
  EXPECT_TRUE(lines.poll(26'000).estop_active);
  EXPECT_TRUE(lines.poll(30'999).estop_active);
  EXPECT_FALSE(lines.poll(31'000).estop_active);
}

// A chip that goes is a stop in the same reading, without debouncing, and it is told why.
TEST_F(LinesTest, LossIsAStopAtOnce) {
  chip.levels = {true, true, true, true, true};
  Lines lines(params, chip);
  ASSERT_FALSE(lines.poll(0).estop_active);
  chip.lose();
  EXPECT_EQ(lines.poll(1), kAssumed);
  EXPECT_EQ(lines.num_losses(), 1);
  EXPECT_EQ(lines.problem(), "the test took it away");
  EXPECT_EQ(lines.wake_fd(), -1);
}

// A lost chip is tried again after 50, 100, 200, 400, 800, 800 ms, not in between; found again it
// is read at once, and the next loss is tried again after 50 ms.
TEST_F(LinesTest, IsFoundAgainWithBackoff) {
  Lines lines(params, chip);
  lines.poll(0);
  chip.lose();
  chip.refusal = "unplugged";
  lines.poll(1'000);
  chip.num_opens = 0;
  std::vector<std::int64_t> attempts_us;
  for (std::int64_t now_us = 1'000; now_us <= 2'500'000; now_us += 1'000) {
    const int before = chip.num_opens;
    EXPECT_EQ(lines.poll(now_us), kAssumed);
    if (chip.num_opens > before) attempts_us.push_back(now_us - 1'000);
  }
  const std::vector<std::int64_t> expected_us = {50'000,  150'000,   350'000,
                                                 750'000, 1'550'000, 2'350'000};
  EXPECT_EQ(attempts_us, expected_us);
  EXPECT_EQ(lines.problem(), "unplugged");

  chip.refusal = "";
  std::int64_t now_us = 2'500'000;
  while (lines.poll(now_us).lost) now_us += kPeriod_us;
  EXPECT_LE(now_us, 2'351'000 + 800'000 + kPeriod_us);
  EXPECT_FALSE(lines.states().estop_active);

  chip.lose();
  lines.poll(now_us);
  EXPECT_TRUE(lines.poll(now_us + 49'999).lost);
  EXPECT_FALSE(lines.poll(now_us + 50'000).lost);
  EXPECT_EQ(lines.num_losses(), 2);
}

// A chip that comes back only to go again, every time, is not tried without end: backoff grows.
TEST_F(LinesTest, AChipThatFlapsIsNotHammered) {
  chip.status_when_open = ReadStatus::kLost;
  Lines lines(params, chip);
  for (std::int64_t now_us = 0; now_us < 10'000'000; now_us += kPeriod_us) lines.poll(now_us);
  EXPECT_LE(chip.num_opens, 17);
  EXPECT_GE(chip.num_opens, 12);
}

// A chip that is open but has told no levels yet is still lost; the first levels end that.
TEST_F(LinesTest, PendingIsLost) {
  chip.status_when_open = ReadStatus::kPending;
  Lines lines(params, chip);
  EXPECT_NE(lines.open(1), "");
  EXPECT_EQ(lines.poll(0), kAssumed);
  chip.status = ReadStatus::kDone;
  EXPECT_FALSE(lines.poll(1).estop_active);
}

// A stop pressed while the chip was away is seen when it is back, in the first reading.
TEST_F(LinesTest, PressedWhileAway) {
  Lines lines(params, chip);
  lines.poll(0);
  chip.lose();
  lines.poll(1'000);
  chip.press_estop(true);
  const LineStates& states = lines.poll(51'000);
  EXPECT_FALSE(states.lost);
  EXPECT_TRUE(states.estop_active);
}

// Opening twice opens once.
TEST_F(LinesTest, OpenTwice) {
  Lines lines(params, chip);
  EXPECT_EQ(lines.open(), "");
  EXPECT_EQ(lines.open(), "");
  EXPECT_EQ(chip.num_opens, 1);
}

}  // namespace
}  // namespace gpio
