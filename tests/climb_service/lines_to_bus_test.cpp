// SPDX-License-Identifier: BSD-3-Clause
// From the E-stop's wire to the frames on the servo bus: the simulated robot's line hub, a socket,
// the lines, one control cycle, the master; all of it in virtual time, on a grid of 1 ms.
#include <bitset>

#include <gtest/gtest.h>
#include <poll.h>

#include "cycle_bench.h"
#include "simulator/plant/line_hub.h"
#include "tests/support/temporary_folder.h"

namespace climb_controller {
namespace {

using climb::ControllerState;
using climb::Fault;
using climb::Order;

/// A control word that makes an enabled drive begin its quick stop (CiA 402: bits 7, 2, 1 = 0 0 1).
bool is_quick_stop(const simulator::BusFrame& frame) {
  return (simulator::number_at(frame, 0, 2) & 0x86U) == 0x02U;
}

struct LinesToBus : testing::Test {
  LinesToBus() { params.chip = "unix:" + path; }

  /// A robot at its dock, and lines that have been told their levels.
  bool arm_anew() {
    bench.emplace();
    chip = gpio::make_line_chip(params);
    bench->lines = &lines.emplace(params, *chip);
    bench->on_millisecond = [this] { one_millisecond(); };
    hub.reset();
    hub.emplace(path).publish(bench->plant.lines());
    lines->poll(0);
    hub->receive();
    return arm();
  }

  /// The plant's process, and the controller's wait for the next cycle.
  void one_millisecond() {
    if (bench->now_us == act_us) act();
    if (hub) {
      hub->receive();
      hub->publish(bench->plant.lines());
    }
    pollfd waiting{lines->wake_fd(), POLLIN, 0};
    if (is_woken && ::poll(&waiting, 1, 0) == 1) lines->poll(bench->now_us);
  }

  bool arm() {
    return bench->reach(ControllerState::kDisarmed) &&
           bench->order(Order::kArm) == climb::CommandVerdict::kAccepted &&
           bench->reach(ControllerState::kHold, 120.0);
  }

  /// `what` happens `after_ms` into the next period; milliseconds from there until the last of the
  /// sixteen drives is told to stop quickly, or -1.
  int milliseconds_to_quick_stop(int after_ms, std::function<void()> what) {
    act = std::move(what);
    act_us = bench->now_us + std::int64_t{after_ms} * 1000;
    std::bitset<16> told;
    for (int i = 0; i < 10; ++i) {
      bench->step();
      for (const simulator::CarriedFrame& carried : bench->carried) {
        const std::uint32_t node = carried.frame.id - 0x200U;
        if (node < 1 || node > 16 || !is_quick_stop(carried.frame)) continue;
        EXPECT_GE(carried.time_us, act_us);
        told.set(node - 1);
        if (told.all()) return static_cast<int>((carried.time_us - act_us) / 1000);
      }
    }
    return -1;
  }

  support::TemporaryFolder folder;
  std::string path = folder / "lines";
  gpio::LinesParams params;
  std::unique_ptr<gpio::LineChip> chip;
  std::optional<gpio::Lines> lines;
  std::optional<simulator::LineHub> hub;
  std::optional<CycleBench> bench;
  bool is_woken = true;
  std::function<void()> act = [] {};
  std::int64_t act_us = -1;
};

/// The parameter: milliseconds into the period.
struct EstopBound : LinesToBus, testing::WithParamInterface<int> {};

// Pressed, or its wire broken, at any millisecond of a period: all drives are told to stop quickly
// in the first period that ends 5 ms or more after it (14 ms at most) when the edge wakes us, in
// the second period (19 ms at most) when it does not; the state is ESTOP, the reason the E-stop.
TEST_P(EstopBound, FromTheWireToEveryDrive) {
  for (const bool woken : {true, false}) {
    for (const bool breaks : {false, true}) {
      is_woken = woken;
      ASSERT_TRUE(arm_anew()) << bench->problems();
      const int taken_ms = milliseconds_to_quick_stop(GetParam(), [&] {
        if (breaks) {
          bench->plant.set_wire_fault(simulator::kEstopN, simulator::WireFault::kStuckLow);
        } else {
          bench->plant.press_estop(true);
        }
      });
      const int to_period_ms = 10 - GetParam();
      EXPECT_EQ(taken_ms, woken && to_period_ms >= 5 ? to_period_ms : to_period_ms + 10);
      EXPECT_EQ(bench->state(), ControllerState::kEstop);
      EXPECT_EQ(bench->reason(), Fault::kEstop);
    }
  }
}
INSTANTIATE_TEST_SUITE_P(EachMillisecond, EstopBound, testing::Range(1, 11));

// The hub dies: every drive is told within one period, since nothing is debounced.
TEST_F(LinesToBus, LostLinesStopAtOnce) {
  ASSERT_TRUE(arm_anew()) << bench->problems();
  const int taken_ms = milliseconds_to_quick_stop(3, [&] { hub.reset(); });
  EXPECT_GE(taken_ms, 0);
  EXPECT_LE(taken_ms, 10);
  EXPECT_EQ(bench->state(), ControllerState::kEstop);
  EXPECT_EQ(bench->reason(), Fault::kLinesLost);
}

// Let go, nothing moves: it stays in ESTOP until the operator's reset, which is refused while the
// stop is pressed; then it can be armed again.
TEST_F(LinesToBus, ReleaseAloneMovesNothing) {
  ASSERT_TRUE(arm_anew()) << bench->problems();
  ASSERT_GE(milliseconds_to_quick_stop(3, [&] { bench->plant.press_estop(true); }), 0);
  EXPECT_NE(bench->order(Order::kReset), climb::CommandVerdict::kAccepted);
  bench->plant.press_estop(false);
  bench->run_s(2.0);
  EXPECT_FALSE(lines->states().estop_active);
  EXPECT_EQ(bench->state(), ControllerState::kEstop);
  EXPECT_EQ(bench->order(Order::kReset), climb::CommandVerdict::kAccepted) << bench->problems();
  EXPECT_TRUE(arm()) << bench->problems();
}

}  // namespace
}  // namespace climb_controller
