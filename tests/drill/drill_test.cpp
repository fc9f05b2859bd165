// SPDX-License-Identifier: BSD-3-Clause
// The drill itself: it runs every row, the same each time, and finds what is broken on purpose.
#include "robot_in_a_box/drill.h"

#include <gtest/gtest.h>

#include "robot_in_a_box/drill_configuration.h"
#include "robot_in_a_box/random_drill.h"

namespace robot_in_a_box {
namespace {

// The table has a way to play each of its 32 rows, and every entry says what it needs to.
TEST(Drill, KnowsEveryRow) {
  std::set<int> numbers = {configuration_row().number};
  for (const DrillRow& row : drill_rows()) {
    numbers.insert(row.number);
    EXPECT_NE(row.applies, nullptr) << row.number;
    EXPECT_NE(row.inject, nullptr) << row.number;
    EXPECT_NE(row.has_reacted, nullptr) << row.number;
    EXPECT_GT(row.bound_us, 0) << row.number;
    EXPECT_GT(row.watch_us, row.bound_us) << row.number;
  }
  for (int number = 1; number <= 32; ++number) EXPECT_EQ(numbers.count(number), 1U) << number;
}

// A fault-free climb from the dock to the top breaks no invariant, and visits every limb state of a
// step with every leg.
TEST(Drill, ClimbsToTheTop) {
  ClimbBox box(tour_params(TourKind::kClimb, 1));
  Tour tour(TourKind::kClimb, box);
  std::set<std::pair<int, climb::LimbState>> visited;
  while (!tour.is_over()) {
    tour.act();
    box.cycle();
    const Situation now = situation_of(box);
    if (now.state == climb::ControllerState::kClimbing) visited.insert({now.leg, now.limb});
  }
  EXPECT_TRUE(box.report().output.at_top);
  EXPECT_EQ(box.monitor().num_violations(), 0) << describe(box.monitor().violations().front());
  EXPECT_GT(box.monitor().num_targets(), 100'000);
  for (int leg = 0; leg < climb::kNumLegs; ++leg) {
    for (int limb = 1; limb <= static_cast<int>(climb::LimbState::kLoading); ++limb) {
      EXPECT_EQ(visited.count({leg, static_cast<climb::LimbState>(limb)}), 1U) << leg << limb;
    }
  }
}

// Stopped in every situation and armed again, on the ladder as well: no invariant is broken.
TEST(Drill, RearmsOnTheLadder) {
  for (const TourKind kind : {TourKind::kStops, TourKind::kEstops}) {
    ClimbBox box(tour_params(kind, 1));
    Tour tour(kind, box);
    while (!tour.is_over() && box.now_us() < 150'000'000) {
      tour.act();
      box.cycle();
    }
    EXPECT_EQ(box.monitor().num_violations(), 0)
        << name(kind) << " " << describe(box.monitor().violations().front());
    EXPECT_FALSE(box.plant().truth().fallen);
  }
}

// The same seed gives the same frames; another one does not.
TEST(Drill, SeedSaysEverything) {
  const auto once = run_random(3, 2, 2);
  const auto again = run_random(3, 2, 1);
  ASSERT_EQ(once.size(), 2U);
  for (std::size_t i = 0; i < once.size(); ++i) {
    EXPECT_EQ(once[i].frame_hash, again[i].frame_hash);
    EXPECT_EQ(once[i].situation, again[i].situation);
    EXPECT_GT(once[i].num_targets, 0);
  }
  EXPECT_NE(once[0].frame_hash, once[1].frame_hash);
}

// E-stop and a dead controller, in each tenth situation of a climb.
TEST(Drill, StopsInTime) {
  DrillOptions options;
  options.rows = {11, 20, 23};
  options.tours = {TourKind::kClimb};
  options.every = 10;
  for (const RowScore& row : run_drill(options).rows) {
    if (options.rows.count(row.row->number) == 0) continue;
    EXPECT_GT(row.cases, 0) << row.row->number;
    EXPECT_EQ(row.missed, 0) << (row.misses.empty() ? "" : row.misses.front());
  }
}

/// A climb until the first limb is in the air.
void come_to_transit(ClimbBox& box, Tour& tour) {
  while (situation_of(box).limb != climb::LimbState::kTransit && !tour.is_over()) {
    tour.act();
    box.cycle();
  }
}

const DrillRow& row_of(int number) {
  for (const DrillRow& row : drill_rows()) {
    if (row.number == number) return row;
  }
  return configuration_row();
}

// A controller whose watch is broken (it never finds rungs too old, never notices a fall) is found.
TEST(Drill, FindsABrokenController) {
  for (const int number : {1, 27}) {
    ClimbBoxParams params = tour_params(TourKind::kClimb, 1);
    params.cycle.controller.watch.max_ladder_age_us = 900'000;
    params.cycle.controller.watch.min_upright_cosine = 0.7;
    ClimbBox box(params);
    Tour tour(TourKind::kClimb, box);
    come_to_transit(box, tour);
    const CaseResult result = CaseRun(box, row_of(number), 0, 1).run();
    EXPECT_TRUE(result.visible) << number;
    EXPECT_FALSE(result.met) << number;
  }
}

// A controller that takes 100 ms too long is late, not excused.
TEST(Drill, FindsASlowController) {
  ClimbBox box(tour_params(TourKind::kClimb, 1));
  Tour tour(TourKind::kClimb, box);
  come_to_transit(box, tour);
  DrillRow slow = row_of(23);
  slow.inject = [](CaseRun& run) { run.memo = 0; };
  slow.go_on = [](CaseRun& run) {
    if (run.since_us() == 100'000) run.box().plant().press_estop(true);
  };
  const CaseResult result = CaseRun(box, slow, 0, 1).run();
  EXPECT_FALSE(result.met);
  EXPECT_GT(result.reaction_us, 20'000);
}

// A drive that a rival moves while the controller looks on is found by the monitor: the invariants
// are judged on the bus, not by what the controller says.
TEST(Drill, MonitorFindsAForeignTarget) {
  ClimbBox box(tour_params(TourKind::kClimb, 1));
  Tour tour(TourKind::kClimb, box);
  come_to_transit(box, tour);
  ASSERT_EQ(box.monitor().num_violations(), 0);
  simulator::BusFrame jump;
  jump.id = 0x202;
  jump.length = 8;
  simulator::put_number(jump, 0, 2, 0x0F);
  simulator::put_number(jump, 2, 4, 20'000);
  simulator::put_number(jump, 6, 2, 1500);
  box.send_foreign(jump);
  for (int i = 0; i < 3; ++i) box.cycle();
  EXPECT_GT(box.monitor().num_violations(), 0);
}

}  // namespace
}  // namespace robot_in_a_box
