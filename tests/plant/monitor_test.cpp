// SPDX-License-Identifier: BSD-3-Clause
// The monitor notices each broken invariant, and is silent over a run that breaks none.
#include "simulator/plant/monitor.h"

#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "robot_bench.h"

namespace simulator {
namespace {

/// Four claws on their rungs, watched in every millisecond.
struct WatchedBench {
  explicit WatchedBench(const PlantParams& params = gripping_params())
      : bench(params), monitor(MonitorParams(params)) {}

  void watch() {
    for (const CarriedFrame& carried : bench.carried) monitor.on_frame(carried);
    bench.carried.clear();
    monitor.on_truth(bench.plant.truth());
  }
  void cycles(int num, int control_word = 0x0F) {
    for (int i = 0; i < num; ++i) {
      bench.cycle(control_word);
      watch();
    }
  }
  void start(bool armed = true) {
    watch();
    if (armed) monitor.on_session(bench.now_us, SessionEvent::kArmed);
    bench.configure();
    for (const int word : {0x06, 0x07, 0x0F}) cycles(1, word);
    for (int leg = 0; leg < kNumLegs; ++leg) bench.move_jaw(leg, -0.6);
    cycles(30);
  }
  std::set<int> broken() const {
    std::set<int> invariants;
    for (const Violation& violation : monitor.violations()) {
      invariants.insert(violation.invariant);
    }
    return invariants;
  }
  std::string first() const {
    return monitor.violations().empty() ? "" : describe(monitor.violations().front());
  }

  RobotBench bench;
  Monitor monitor;
};

using testing::ElementsAre;
using testing::IsEmpty;

// One claw opens, moves away and back, and closes again: nothing to object to.
TEST(Monitor, SilentOverAStep) {
  WatchedBench run;
  run.start();
  const Eigen::Vector3d home = run.bench.plant.truth().legs[0].p_world_foot_m;
  run.bench.move_jaw(0, 1.2);
  run.cycles(40);
  run.bench.move_foot(0, home + Eigen::Vector3d(-0.05, 0.0, 0.05));
  run.cycles(60);
  run.bench.move_foot(0, home);
  run.cycles(60);
  run.bench.move_jaw(0, -0.6);
  run.cycles(60);
  EXPECT_TRUE(run.bench.plant.truth().legs[0].bears);
  EXPECT_THAT(run.broken(), IsEmpty()) << run.first();
  EXPECT_GT(run.monitor.num_targets(), 1000);
}

// Two claws opened at once: the second one was not allowed (I3), and is lost unduly (I1).
TEST(Monitor, SeesTwoClawsOpening) {
  WatchedBench run;
  run.start();
  run.bench.move_jaw(0, 1.2);
  run.bench.move_jaw(3, 1.2);
  run.cycles(30);
  EXPECT_THAT(run.broken(), ElementsAre(1, 3)) << run.first();
}

// Thicker rungs hold the jaws wider open: told to stand where they stand is no opening, wider is.
TEST(Monitor, KnowsAJawOnAThickRung) {
  PlantParams params = gripping_params();
  for (LadderRung& rung : params.rungs) rung.radius_m = 0.018;
  WatchedBench run(params);
  run.start();
  const double jaw_rad = run.bench.plant.drive(axis_of(0, 3)).measured_rad();
  EXPECT_GT(jaw_rad, -0.25);
  for (const int leg : {0, 3}) run.bench.move_jaw(leg, jaw_rad + 0.01);
  run.cycles(30);
  EXPECT_THAT(run.broken(), IsEmpty()) << run.first();
  for (const int leg : {0, 3}) run.bench.move_jaw(leg, jaw_rad + 0.3);
  run.cycles(30);
  EXPECT_THAT(run.broken(), ElementsAre(1, 3)) << run.first();
}

// A grasp that a breaking rung took away is no fault of the controller; opening another one a
// second later is.
TEST(Monitor, ExcusesThePlantOnlyForAWhile) {
  PlantParams params = gripping_params();
  params.start_rung = {2, 3, 0, 1};
  params.body_height_m = 0.75;
  WatchedBench run(params);
  run.start();
  run.bench.plant.world().rung(2).break_at_us = run.bench.now_us;
  run.cycles(100);
  EXPECT_THAT(run.broken(), IsEmpty()) << run.first();
  run.bench.move_jaw(3, 1.2);
  run.cycles(30);
  EXPECT_THAT(run.broken(), ElementsAre(1, 3));
}

// A jaw whose drive turns the wrong way opens although it was told to close: no fault of the
// controller. Opening another one a second later is.
TEST(Monitor, ExcusesAJawAgainstItsCommand) {
  WatchedBench run;
  run.start();
  run.bench.plant.drive(axis_of(0, 3)).motor().reversed = true;
  run.cycles(100);
  EXPECT_EQ(run.bench.plant.truth().legs[0].last_loss, LossCause::kOpened);
  EXPECT_THAT(run.broken(), IsEmpty()) << run.first();
  run.bench.move_jaw(1, 1.2);
  run.cycles(30);
  EXPECT_EQ(run.broken().count(1), 1U);
}

// Releasing the dock with nothing in the claws is a violation of I1.
TEST(Monitor, SeesUndockingWithoutGrasps) {
  WatchedBench run{PlantParams{}};
  run.watch();
  run.bench.plant.set_docked(false);
  run.bench.advance(10'000);
  run.watch();
  EXPECT_THAT(run.broken(), ElementsAre(1)) << run.first();
}

// A target out of limits and a jump are seen (I2).
TEST(Monitor, SeesLimitsAndJumps) {
  WatchedBench run;
  run.start();
  run.bench.goal_rad[1] += 0.03;
  run.bench.target_rad[1] += 0.03;
  run.cycles(1);
  EXPECT_THAT(run.broken(), ElementsAre(2)) << run.first();
  WatchedBench far;
  far.start();
  far.bench.goal_rad[0] = 1.0;
  far.cycles(70);
  EXPECT_THAT(far.broken(), ElementsAre(2)) << far.first();
}

/// The rules of one axis are other ones from now on.
Monitor with_rule(const WatchedBench& run, int axis, const AxisRules& rule) {
  MonitorParams params{gripping_params()};
  params.rules[static_cast<std::size_t>(axis)] = rule;
  Monitor monitor(params);
  monitor.on_session(run.bench.now_us, SessionEvent::kArmed);
  return monitor;
}

// An axis that stands outside its limits may be enabled there and led inwards, not outwards (I2).
TEST(Monitor, LetsAnAxisLeaveWhereItStandsOutside) {
  for (const double by_rad : {-0.02, 0.02}) {
    WatchedBench run;
    const double measured_rad = run.bench.plant.drive(1).measured_rad();
    run.watch();
    run.monitor = with_rule(run, 1, {measured_rad - 1.0, measured_rad - 0.03, 2.5});
    run.bench.configure();
    for (const int word : {0x06, 0x07, 0x0F, 0x0F}) run.cycles(1, word);
    EXPECT_THAT(run.broken(), IsEmpty()) << run.first();
    run.bench.goal_rad[1] += by_rad;
    run.cycles(5);
    if (by_rad < 0.0) {
      EXPECT_THAT(run.broken(), IsEmpty()) << run.first();
    } else {
      EXPECT_THAT(run.broken(), ElementsAre(2)) << run.first();
    }
  }
}

// Led inwards in vain, an axis that stands outside its limits may be held where it stands (I2).
TEST(Monitor, LetsAnAxisBeHeldWhereItStandsOutside) {
  for (const double beyond_rad : {0.0, 0.01}) {
    WatchedBench run;
    const double stands_rad = run.bench.plant.drive(1).measured_rad();
    run.watch();
    run.monitor = with_rule(run, 1, {stands_rad - 1.0, stands_rad - 0.01, 2.5});
    run.bench.configure();
    for (const int word : {0x06, 0x07, 0x0F, 0x0F}) run.cycles(1, word);
    run.bench.plant.drive(1).motor().stuck = true;
    run.bench.goal_rad[1] -= 0.02;
    run.cycles(6);
    ASSERT_THAT(run.broken(), IsEmpty()) << run.first();
    run.bench.goal_rad[1] = run.bench.target_rad[1] = stands_rad + beyond_rad;
    run.cycles(1);
    EXPECT_EQ(run.broken().count(2), beyond_rad > 0.0 ? 1U : 0U) << run.first();
  }
}

// To where the axis stands is no jump, as far elsewhere is one (I2).
TEST(Monitor, LetsATargetGoToWhereTheAxisStands) {
  for (const double part : {1.0, -1.0}) {
    WatchedBench run;
    run.start();
    run.bench.plant.drive(1).motor().stuck = true;
    run.bench.goal_rad[1] += 0.1;
    run.cycles(6);
    ASSERT_THAT(run.broken(), IsEmpty()) << run.first();
    const double off_rad = run.bench.plant.drive(1).measured_rad() - run.bench.target_rad[1];
    ASSERT_GT(std::abs(off_rad), 0.05);
    run.bench.goal_rad[1] = run.bench.target_rad[1] += part * off_rad;
    run.cycles(1);
    EXPECT_EQ(run.broken().count(2), part > 0.0 ? 0U : 1U) << run.first();
  }
}

// Targets that run on after the E-stop's reaction time are seen (I4); targets that freeze are not.
TEST(Monitor, SeesMotionAfterStop) {
  for (const bool obeys : {false, true}) {
    WatchedBench run;
    run.start();
    run.bench.move_jaw(0, 1.2);
    run.cycles(30);
    run.bench.goal_rad[1] += 1.5;
    run.cycles(5);
    run.bench.plant.set_wire_fault(kEstopN, WireFault::kStuckLow);
    run.cycles(1);
    if (obeys) run.bench.goal_rad = run.bench.target_rad;
    run.cycles(40);
    if (obeys) {
      EXPECT_THAT(run.broken(), IsEmpty()) << run.first();
    } else {
      EXPECT_THAT(run.broken(), ElementsAre(4)) << run.first();
      EXPECT_NEAR(
          1e-3 * static_cast<double>(run.monitor.violations().front().time_us - run.bench.now_us),
          -400.0 + 180.0, 30.0);
    }
  }
}

// Enabling before the operator armed is seen (I5), also after disarming.
TEST(Monitor, SeesEnablingUnarmed) {
  WatchedBench run;
  run.start(false);
  EXPECT_THAT(run.broken(), ElementsAre(5)) << run.first();
  WatchedBench later;
  later.start();
  EXPECT_THAT(later.broken(), IsEmpty()) << later.first();
  later.monitor.on_session(later.bench.now_us, SessionEvent::kDisarmed);
  later.cycles(1);
  EXPECT_THAT(later.broken(), ElementsAre(5));
}

// A first target three counts off what was measured is seen (I6), two counts are not.
TEST(Monitor, SeesAFirstTargetElsewhere) {
  for (const int off : {2, 3}) {
    WatchedBench run;
    run.watch();
    run.monitor.on_session(run.bench.now_us, SessionEvent::kArmed);
    run.bench.configure();
    for (const int word : {0x06, 0x07}) run.cycles(1, word);
    const double angle = off / 10430.0;
    run.bench.target_rad[1] += angle;
    run.bench.goal_rad[1] += angle;
    run.cycles(1);
    EXPECT_EQ(run.broken().count(6), off == 3 ? 1U : 0U) << run.first();
  }
}

// A master that goes on sending after bus-off is seen (I7) until the operator resets.
TEST(Monitor, SeesSendingOverABusFault) {
  WatchedBench run;
  run.start();
  BusFrame bus_off;
  bus_off.id = kBusOffError;
  bus_off.length = 8;
  run.monitor.on_frame({run.bench.now_us, run.bench.now_us, 0, bus_off});
  run.bench.master_alive = false;
  run.cycles(5);
  EXPECT_THAT(run.broken(), IsEmpty()) << run.first();
  run.bench.master_alive = true;
  run.cycles(1);
  EXPECT_EQ(run.broken().count(7), 1U);
  const auto before = run.monitor.num_violations();
  run.monitor.on_session(run.bench.now_us, SessionEvent::kReset);
  run.cycles(1);
  EXPECT_EQ(run.monitor.num_violations(), before);
}

// A stop without a reason, and one whose reason changes, are seen (I8).
TEST(Monitor, SeesUnclearReasons) {
  Monitor monitor{MonitorParams(PlantParams{})};
  monitor.on_stop(1, 11);
  monitor.on_stop(2, 11);
  monitor.on_run(3);
  monitor.on_stop(4, 13);
  EXPECT_EQ(monitor.num_violations(), 0);
  monitor.on_stop(5, 11);
  monitor.on_run(6);
  monitor.on_stop(7, 0);
  EXPECT_EQ(monitor.num_violations(), 2);
  EXPECT_EQ(monitor.violations().front().invariant, 8);
}

// Frames that waited in a stalled queue and leave late are seen (I9).
TEST(Monitor, SeesStaleFrames) {
  WatchedBench run;
  run.start();
  run.bench.bus.set_condition(BusCondition::kStalled, run.bench.now_us);
  run.cycles(3);
  EXPECT_THAT(run.broken(), IsEmpty()) << run.first();
  run.bench.bus.set_condition(BusCondition::kUp, run.bench.now_us);
  run.cycles(1);
  EXPECT_EQ(run.broken().count(9), 1U);
}

// A process that did not run could not take back what it had handed over; that it ran again for
// long enough is seen.
TEST(Monitor, ExcusesLateFramesOfAPause) {
  Monitor monitor{MonitorParams(PlantParams{})};
  BusFrame sync;
  sync.id = 0x080;
  monitor.on_pause(1'005'000, 1'200'000);
  monitor.on_frame({1'210'000, 1'000'000, 0, sync});
  EXPECT_EQ(monitor.num_violations(), 0);
  monitor.on_frame({1'217'000, 1'000'000, 0, sync});
  EXPECT_EQ(monitor.num_violations(), 1);
}

// What somebody else sends as a master, late and over a bus fault, is not the judged master's
// doing.
TEST(Monitor, KnowsWhoseFramesAreJudged) {
  for (const int judged : {0, 1}) {
    MonitorParams params{PlantParams{}};
    params.master_port = judged;
    Monitor monitor(params);
    BusFrame sync;
    sync.id = 0x080;
    monitor.on_frame({1'000'000, 900'000, 1, sync});
    BusFrame bus_off;
    bus_off.id = kBusOffError;
    bus_off.length = 8;
    monitor.on_frame({1'000'000, 1'000'000, 2, bus_off});
    monitor.on_frame({1'100'000, 1'100'000, 1, sync});
    EXPECT_EQ(monitor.num_violations(), judged == 1 ? 2 : 0);
  }
}

}  // namespace
}  // namespace simulator
