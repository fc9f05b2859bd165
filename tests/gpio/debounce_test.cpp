// SPDX-License-Identifier: BSD-3-Clause
#include "gpio/debounce.h"

#include <vector>

#include <gtest/gtest.h>

#include "base/rng.h"

namespace gpio {
namespace {

// The first reading counts at once, whatever it is: a machine that starts with the stop pressed, or
// not pressed, knows it in its first cycle.
TEST(Debounce, FirstReadingCounts) {
  for (const bool level : {false, true}) {
    Debounce debounce(5'000);
    EXPECT_EQ(debounce.update(0, level), level);
    EXPECT_EQ(debounce.update(1, level), level);
  }
}

// A new level counts exactly when it has lasted the whole time, not a microsecond before.
TEST(Debounce, CountsAtExactlyItsTime) {
  Debounce debounce(5'000);
  debounce.update(0, false);
  EXPECT_FALSE(debounce.update(10'000, true));
  EXPECT_FALSE(debounce.update(14'999, true));
  EXPECT_TRUE(debounce.update(15'000, true));
}

// No time asked for: every reading counts at once.
TEST(Debounce, ZeroPassesEverything) {
  Debounce debounce(0);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(debounce.update(i, i % 3 == 0), i % 3 == 0);
}

// One reading of the old level starts the time anew.
TEST(Debounce, ABounceStartsAnew) {
  Debounce debounce(5'000);
  debounce.update(0, false);
  debounce.update(1'000, true);
  debounce.update(4'000, false);
  EXPECT_FALSE(debounce.update(6'000, true));
  EXPECT_FALSE(debounce.update(10'999, true));
  EXPECT_TRUE(debounce.update(11'000, true));
}

// The same time twice, and a clock that goes back, neither lengthen nor complete the wait.
TEST(Debounce, OddClocks) {
  Debounce debounce(5'000);
  debounce.update(100'000, false);
  EXPECT_FALSE(debounce.update(100'000, true));
  EXPECT_FALSE(debounce.update(100'000, true));
  EXPECT_FALSE(debounce.update(50'000, true));
  EXPECT_TRUE(debounce.update(55'000, true));
}

// After a restart the next reading counts at once, even in the midst of a change.
TEST(Debounce, RestartForgets) {
  Debounce debounce(5'000);
  debounce.update(0, false);
  debounce.update(1'000, true);
  debounce.restart();
  EXPECT_TRUE(debounce.update(1'001, true));
}

/// Literal: the level is the newest one that was read without a break for the whole time.
bool reference(const std::vector<std::pair<std::int64_t, bool>>& readings, std::int64_t hold_us) {
  bool level = readings.front().second;
  for (std::size_t last = 0; last < readings.size(); ++last) {
    std::size_t first = last;
    while (first > 0 && readings[first - 1].second == readings[last].second) --first;
    if (readings[last].first - readings[first].first >= hold_us) level = readings[last].second;
  }
  return level;
}

// Against the definition taken literally, over random bouncing at random times.
TEST(Debounce, AgreesWithItsDefinition) {
  base::Rng rng(7);
  for (int run = 0; run < 200; ++run) {
    const std::int64_t hold_us = static_cast<std::int64_t>(rng.below(8'000));
    Debounce debounce(hold_us);
    std::vector<std::pair<std::int64_t, bool>> readings;
    std::int64_t now_us = 0;
    bool level = false;
    for (int i = 0; i < 60; ++i) {
      now_us += static_cast<std::int64_t>(rng.below(4'000));
      if (rng.below(3) == 0) level = !level;
      readings.emplace_back(now_us, level);
      ASSERT_EQ(debounce.update(now_us, level), reference(readings, hold_us)) << run << ' ' << i;
    }
  }
}

}  // namespace
}  // namespace gpio
