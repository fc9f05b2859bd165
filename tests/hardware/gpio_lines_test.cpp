// SPDX-License-Identifier: BSD-3-Clause
// Touch switches and E-stop on a GPIO chip of the kernel, through the installed libgpiod. Every
// change is waited for before the next: gpio-sim merges edges that come faster than they are read.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <optional>
#include <thread>

#include <gmock/gmock.h>
#include <poll.h>

#include "base/rng.h"
#include "gpio/lines.h"
#include "tests/hardware/gpio_chip.h"

namespace {

using gpio::Bias;
using gpio::kEstop;
using gpio::kNumLines;
using gpio::kNumTouch;
using gpio::LineChip;
using gpio::Lines;
using gpio::LinesParams;
using gpio::LineStates;
using hardware::SimulatedChip;
using testing::AllOf;
using testing::HasSubstr;

constexpr std::int64_t kPeriod_us = 10'000;
/// 5 ms of debouncing and a tick, 20 ms at most (exact in virtual time, tests/gpio), and 50 ms for
/// the slowness of the emulated machine.
constexpr std::int64_t kBound_us = 70'000;
constexpr int kPatience_ms = 5'000;
constexpr LineStates kAtRest{{}, false, false};
const std::vector<std::string> kNames = {"",         "TOUCH_FL", "TOUCH_FR", "TOUCH_RL",
                                         "TOUCH_RR", "ESTOP_N",  "",         ""};

int offset_of(int line) {
  return line + 1;
}

std::int64_t now_us() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(now).count();
}

/// How long it took until the controller would have known. Bounds are asserted in ticks: an
/// emulated machine may be held up between two of them, as its wall clock shows.
struct Reaction {
  std::int64_t time_us = 0;
  int num_ticks = 0;  ///< periods of the loop that have ended since
};

/// The controller's loop: waits for the next tick, or less when a line wakes it.
class Loop {
 public:
  Loop(Lines& lines, bool wakes) : lines_(lines), wakes_(wakes), tick_us_(now_us()) {}

  /// Until the states are so, or nothing when that takes too long.
  std::optional<Reaction> run_until(const LineStates& wanted) {
    const std::int64_t start_us = now_us();
    Reaction reaction;
    while (now_us() - start_us < std::int64_t{kPatience_ms} * 1000) {
      reaction.num_ticks += wait();
      if (lines_.poll(now_us()) != wanted) continue;
      reaction.time_us = now_us() - start_us;
      return reaction;
    }
    return std::nullopt;
  }

  void run_for(std::int64_t duration_us) {
    const std::int64_t end_us = now_us() + duration_us;
    while (now_us() < end_us) {
      wait();
      lines_.poll(now_us());
    }
  }

 private:
  /// 1 for a tick, 0 when woken before it.
  int wait() {
    while (tick_us_ <= now_us()) tick_us_ += kPeriod_us;
    const std::int64_t left_us = std::max<std::int64_t>(tick_us_ - now_us(), 0);
    pollfd waiting{wakes_ ? lines_.wake_fd() : -1, POLLIN, 0};
    const timespec timeout{0, left_us * 1000};
    return ::ppoll(&waiting, 1, &timeout, nullptr) == 0 ? 1 : 0;
  }

  Lines& lines_;
  bool wakes_;
  std::int64_t tick_us_;
};

/// A list of measured times with its median and worst.
void print_times(const char* what, std::vector<std::int64_t> times_us) {
  std::printf("%s [ms]:", what);
  for (const std::int64_t time_us : times_us) {
    std::printf(" %.1f", static_cast<double>(time_us) / 1000.0);
  }
  std::sort(times_us.begin(), times_us.end());
  std::printf("\n  %zu times, 0 missed, median %.1f, worst %.1f\n", times_us.size(),
              static_cast<double>(times_us[times_us.size() / 2]) / 1000.0,
              static_cast<double>(times_us.back()) / 1000.0);
}

bool wakes_within(int fd, int wait_ms) {
  pollfd waiting{fd, POLLIN, 0};
  return ::poll(&waiting, 1, wait_ms) == 1;
}

struct GpioTest : testing::Test {
  GpioTest() { params.chip = "ladder-test"; }
  void open() {
    line_chip = gpio::make_line_chip(params);
    lines.emplace(params, *line_chip);
    ASSERT_EQ(lines->open(), "");
    loop.emplace(*lines, true);
  }
  void open_at_rest() {
    open();
    chip.set(offset_of(kEstop), true);
    ASSERT_TRUE(loop->run_until(kAtRest));
  }
  std::string refusal() {
    const std::unique_ptr<LineChip> other = gpio::make_line_chip(params);
    return Lines(params, *other).open();
  }
  LinesParams params;
  SimulatedChip chip{"ladder-test", "ladder-test", kNames};
  std::unique_ptr<LineChip> line_chip;
  std::optional<Lines> lines;
  std::optional<Loop> loop;
};

// What cannot be opened says what, where, and how to mend it: label, name, twice, held.
TEST_F(GpioTest, Refusals) {
  params.chip = "no-such-chip";
  EXPECT_THAT(refusal(), AllOf(HasSubstr("no GPIO chip is labelled \"no-such-chip\""),
                               HasSubstr("\"ladder-test\" (/dev/gpiochip")));
  params.chip = "ladder-test";
  params.estop.name = "STOP";
  EXPECT_THAT(refusal(), HasSubstr("has no line named STOP"));
  params.estop = {"", 99, true};
  EXPECT_THAT(refusal(), HasSubstr("none at offset 99"));
  params = {};
  params.chip = "ladder-test";
  {
    const SimulatedChip twin("ladder-twin", "ladder-test", kNames);
    EXPECT_THAT(refusal(), HasSubstr("two GPIO chips are labelled \"ladder-test\""));
  }
  open();
  EXPECT_THAT(refusal(), AllOf(HasSubstr("TOUCH_FL at offset 1 of GPIO chip \"ladder-test\""),
                               HasSubstr("is held by \"climb_controller\"")));
  lines.reset();
  line_chip.reset();
  EXPECT_EQ(refusal(), "") << "given back";
}

// Two lines of one name on the chip: the message says so, and the offset it asks for serves.
TEST_F(GpioTest, OneNameTwice) {
  std::vector<std::string> names = kNames;
  names[7] = "ESTOP_N";
  const SimulatedChip odd("ladder-odd", "ladder-odd", names);
  params.chip = "ladder-odd";
  EXPECT_THAT(refusal(), HasSubstr("two lines named ESTOP_N, at offsets 5 and 7"));
  params.estop.name = "";
  params.estop.offset = 7;
  EXPECT_EQ(refusal(), "");
}

// Each line, up and down, moves its own state and wakes.
TEST_F(GpioTest, EachLine) {
  open_at_rest();
  for (int leg = 0; leg < kNumTouch; ++leg) {
    LineStates touched = kAtRest;
    touched.touch[leg] = true;
    for (const bool pressed : {true, false}) {
      chip.set(offset_of(leg), pressed);
      EXPECT_TRUE(wakes_within(lines->wake_fd(), kPatience_ms)) << leg;
      EXPECT_TRUE(loop->run_until(pressed ? touched : kAtRest)) << leg;
    }
  }
  EXPECT_FALSE(wakes_within(lines->wake_fd(), 100)) << "all edges are taken away";
  for (const bool pressed : {true, false}) {
    chip.set(offset_of(kEstop), !pressed);
    EXPECT_TRUE(wakes_within(lines->wake_fd(), kPatience_ms));
    EXPECT_TRUE(loop->run_until({{}, pressed, false}));
  }
}

// A wire that nobody drives, with the pull that the configuration asks of the chip: a stop.
TEST_F(GpioTest, BrokenWireIsAStop) {
  chip.set(offset_of(kEstop), true);
  open();
  EXPECT_TRUE(loop->run_until({{}, true, false}));
}

// Left as it is, the wire keeps its level over the request.
TEST_F(GpioTest, BiasAsIs) {
  chip.set(offset_of(kEstop), true);
  params.estop.bias = Bias::kAsIs;
  open();
  EXPECT_TRUE(loop->run_until(kAtRest));
}

// Fifty presses of the E-stop at odd moments of the cycle, woken by the edge and not: none missed,
// each known at the second tick, or at the third where the first came late and the second less than
// the 5 ms of debouncing after it. The times are listed.
TEST_F(GpioTest, FiftyPresses) {
  open_at_rest();
  base::Rng rng(23);
  for (const bool wakes : {true, false}) {
    loop.emplace(*lines, wakes);
    std::vector<std::int64_t> times_us;
    for (int i = 0; i < 50; ++i) {
      loop->run_for(kPeriod_us);
      std::this_thread::sleep_for(std::chrono::microseconds(rng.below(kPeriod_us)));
      chip.set(offset_of(kEstop), false);
      const auto pressed = loop->run_until({{}, true, false});
      ASSERT_TRUE(pressed) << "press " << i << " was missed";
      EXPECT_LE(pressed->time_us, kBound_us) << "press " << i;
      EXPECT_LE(pressed->num_ticks, 3) << "press " << i;
      times_us.push_back(pressed->time_us);
      chip.set(offset_of(kEstop), true);
      ASSERT_TRUE(loop->run_until(kAtRest)) << "release " << i;
    }
    print_times(wakes ? "E-stop, woken by edges" : "E-stop, ticks alone", times_us);
  }
}

// The chip unbound, or deleted, while in use: a stop at the next tick at the latest; back again it
// is found by its label within the ticks of a second, twenty times over. The times are listed.
TEST_F(GpioTest, TakenAwayAndBroughtBack) {
  open_at_rest();
  std::vector<std::int64_t> gone_us;
  std::vector<std::int64_t> back_us;
  for (int i = 0; i < 20; ++i) {
    const bool unbinds = i % 2 == 0;
    unbinds ? chip.unbind() : chip.destroy();
    const auto gone = loop->run_until({});
    ASSERT_TRUE(gone) << "loss " << i << " was missed";
    EXPECT_LE(gone->time_us, kBound_us);
    EXPECT_LE(gone->num_ticks, 1);
    gone_us.push_back(gone->time_us);
    EXPECT_EQ(lines->wake_fd(), -1);
    loop->run_for(10 * kPeriod_us);
    EXPECT_EQ(lines->states(), LineStates{});
    unbinds ? chip.bind() : chip.create();
    const auto back = loop->run_until({{}, true, false});
    ASSERT_TRUE(back) << "return " << i << ": " << lines->problem();
    EXPECT_LE(back->num_ticks, 100);
    back_us.push_back(back->time_us);
    chip.set(offset_of(kEstop), true);
    ASSERT_TRUE(loop->run_until(kAtRest));
  }
  print_times("chip gone, to the stop", gone_us);
  print_times("chip back, to its levels", back_us);
  EXPECT_EQ(lines->num_losses(), 20);
}

}  // namespace
