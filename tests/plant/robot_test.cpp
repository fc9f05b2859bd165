// SPDX-License-Identifier: BSD-3-Clause
// The plant as a whole: grasps, touch, forces, breaking rungs, falling, lines, and sameness.
#include <gtest/gtest.h>

#include "robot_bench.h"

namespace simulator {
namespace {

constexpr int kFl = 0;

// In the dock nothing is held, nothing is touched, all sixteen nodes boot once and stay pre-op.
TEST(RobotPlant, WaitsInItsDock) {
  RobotBench bench;
  bench.advance(500'000);
  const PlantTruth truth = bench.plant.truth();
  EXPECT_TRUE(truth.docked);
  EXPECT_FALSE(truth.fallen);
  for (int axis = 0; axis < kNumAxes; ++axis) {
    EXPECT_EQ(bench.num_frames(0x701U + static_cast<std::uint32_t>(axis)), 1);
  }
  for (const LegTruth& leg : truth.legs) EXPECT_FALSE(leg.holds || leg.touch);
  EXPECT_EQ(truth.lines, (LineLevels{false, false, false, false, true}));
  EXPECT_LT((truth.T_world_body.translation() - Eigen::Vector3d(-0.28, 0.0, 0.6)).norm(), 1e-6);
}

// An open claw driven to a rung and closed on it holds it: jaw at -0.44, holding torque 3.2 Nm, and
// the switch closes 30 ms after the jaw presses, not earlier.
TEST(RobotPlant, GraspsARung) {
  RobotBench bench;
  bench.enable();
  bench.move_foot(kFl, {0.0, 0.15, 0.9});
  bench.cycles(80);
  EXPECT_FALSE(bench.plant.leg(kFl).holds);
  bench.move_jaw(kFl, -0.6);
  std::int64_t held_us = -1, touched_us = -1;
  for (int i = 0; i < 800; ++i) {
    if (i % 10 == 0) {
      for (int axis = 0; axis < kNumAxes; ++axis) bench.send_target(axis, 0x0F);
      bench.send(frame_of(0x080, {}));
      bench.send(frame_of(0x77F, {0x05}));
    }
    bench.advance(1000);
    if (held_us < 0 && bench.plant.leg(kFl).holds) held_us = bench.now_us;
    if (touched_us < 0 && bench.plant.lines()[kTouchFl]) touched_us = bench.now_us;
  }
  ASSERT_GE(held_us, 0);
  EXPECT_GE(touched_us - held_us, 30'000);
  EXPECT_LE(touched_us - held_us, 60'000);
  // Where a rung of 28 mm stops it, 0.18 rad before the target, at 20 Nm/rad.
  EXPECT_NEAR(bench.plant.drive(axis_of(kFl, 3)).measured_rad(), -0.42, 0.01);
  EXPECT_NEAR(bench.plant.drive(axis_of(kFl, 3)).motor().torque_Nm(), -3.6, 0.3);
}

// A claw that closes beside the rung reaches its stop at -0.60, without torque, touch or hold.
TEST(RobotPlant, MissesARung) {
  RobotBench bench;
  bench.enable();
  bench.move_foot(kFl, {-0.02, 0.15, 0.9});
  bench.cycles(80);
  bench.move_jaw(kFl, -0.6);
  bench.cycles(80);
  EXPECT_FALSE(bench.plant.leg(kFl).holds);
  EXPECT_FALSE(bench.plant.lines()[kTouchFl]);
  EXPECT_NEAR(bench.plant.drive(axis_of(kFl, 3)).measured_rad(), -0.60, 0.01);
}

// Docked pull test: a held claw pulled 10 mm back moves little and pulls hard; an empty one moves.
TEST(RobotPlant, PullTestTellsGraspFromNone) {
  RobotBench bench;
  bench.enable();
  bench.grasp(kFl, 2);
  ASSERT_TRUE(bench.plant.leg(kFl).holds);
  const Eigen::Vector3d held = bench.plant.truth().legs[0].p_world_foot_m;
  bench.move_foot(kFl, held + Eigen::Vector3d(-0.010, 0.0, 0.0));
  bench.cycles(30);
  const LegTruth pulled = bench.plant.truth().legs[0];
  EXPECT_TRUE(pulled.holds);
  EXPECT_LT((pulled.p_world_foot_m - held).norm(), 0.001);
  EXPECT_GT(pulled.force_on_rung_N.norm(), 40.0);
  EXPECT_LT(pulled.force_on_rung_N.norm(), 150.0);
}

// Hanging on four staggered feet a pull of 10 mm loads the tested claw more than its share and less
// than the alarm, for every leg: what the controller's window of 40 N to 150 N expects.
TEST(RobotPlant, PullTestWhileHanging) {
  for (int leg = 0; leg < kNumLegs; ++leg) {
    PlantParams params = gripping_params();
    params.start_rung = {2, 3, 0, 1};
    params.body_height_m = 0.75;
    RobotBench bench(params);
    close_all(bench);
    const LegTruth before = bench.plant.truth().legs[static_cast<std::size_t>(leg)];
    bench.move_foot(leg, before.p_world_foot_m + Eigen::Vector3d(-0.010, 0.0, 0.0));
    bench.cycles(30);
    const LegTruth after = bench.plant.truth().legs[static_cast<std::size_t>(leg)];
    EXPECT_GT(after.force_on_rung_N.norm(), 40.0);
    EXPECT_LT(after.force_on_rung_N.norm(), 150.0);
    EXPECT_LT((after.p_world_foot_m - before.p_world_foot_m).norm(), 0.001);
  }
}

// Released from the dock the four feet bear the weight together, and the body stays.
TEST(RobotPlant, HangsOnFourFeet) {
  RobotBench bench(gripping_params());
  close_all(bench);
  const PlantTruth truth = bench.plant.truth();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const LegTruth& leg : truth.legs) {
    EXPECT_TRUE(leg.bears && leg.touch);
    sum += leg.force_on_rung_N;
  }
  EXPECT_LT((sum - Eigen::Vector3d(0.0, 0.0, -78.5)).norm(), 0.5);
  EXPECT_LT((truth.T_world_body.translation() - Eigen::Vector3d(-0.28, 0.0, 0.6)).norm(), 1e-3);
  EXPECT_FALSE(truth.fallen);
}

// Fewer than two bearing feet without the dock: the robot falls, the IMU feels nothing meanwhile.
TEST(RobotPlant, FallsBelowTwoFeet) {
  RobotBench bench(gripping_params());
  close_all(bench);
  for (const int leg : {0, 1}) bench.move_jaw(leg, 1.2);
  bench.cycles(40);
  EXPECT_FALSE(bench.plant.truth().fallen);
  EXPECT_EQ(bench.plant.truth().legs[0].last_loss, LossCause::kOpened);
  bench.move_jaw(2, 1.2);
  bench.cycles(15);
  EXPECT_TRUE(bench.plant.truth().fallen);
  EXPECT_LT(bench.plant.imu().specific_force_m_s2.norm(), 0.3 * 9.81);
  EXPECT_LT(bench.plant.T_world_body().translation().z(), 0.6);
  bench.cycles(100);
  EXPECT_NEAR(bench.plant.imu().specific_force_m_s2.norm(), 9.81, 0.2);
}

// A weak rung breaks under load: the claw loses it with that cause, its switch opens at once, the
// others keep theirs.
TEST(RobotPlant, RungBreaksUnderLoad) {
  PlantParams params = gripping_params();
  params.start_rung = {2, 3, 0, 1};
  params.body_height_m = 0.75;
  RobotBench bench(params);
  close_all(bench);
  ASSERT_TRUE(bench.plant.lines()[kTouchFl]);
  const double load_N = bench.plant.truth().legs[0].force_on_rung_N.norm();
  bench.plant.world().rung(2).break_load_N = load_N + 5.0;
  const Eigen::Vector3d foot = bench.plant.truth().legs[0].p_world_foot_m;
  bench.move_foot(kFl, foot + Eigen::Vector3d(-0.015, 0.0, 0.0));
  bench.cycles(40);
  const PlantTruth truth = bench.plant.truth();
  EXPECT_EQ(truth.num_broken_rungs, 1);
  EXPECT_EQ(truth.legs[0].last_loss, LossCause::kRungBroke);
  EXPECT_FALSE(bench.plant.lines()[kTouchFl]);
  for (int leg = 1; leg < kNumLegs; ++leg) {
    EXPECT_TRUE(truth.legs[static_cast<std::size_t>(leg)].bears);
  }
  EXPECT_FALSE(truth.fallen);
}

// Rungs break on time and on touch as told.
TEST(RobotPlant, RungBreaksOnTimeAndOnTouch) {
  PlantParams params = gripping_params();
  params.rungs[2].break_at_us = 400'000;
  params.rungs[5].break_on_touch = true;
  RobotBench bench(params);
  close_all(bench);  // takes 370 ms
  EXPECT_EQ(bench.plant.truth().num_broken_rungs, 0);
  bench.cycles(5);
  EXPECT_EQ(bench.plant.truth().num_broken_rungs, 1);
  EXPECT_FALSE(bench.plant.world().rung(5).broken);
}

// A cut E-stop wire reads as pressed, whatever the button does; a cut touch wire reads as no grasp.
TEST(RobotPlant, BrokenWiresReadSafe) {
  RobotBench bench(gripping_params());
  close_all(bench);
  bench.plant.set_wire_fault(kEstopN, WireFault::kStuckLow);
  bench.plant.set_wire_fault(kTouchFl, WireFault::kStuckLow);
  EXPECT_FALSE(bench.plant.lines()[kEstopN]);
  EXPECT_FALSE(bench.plant.lines()[kTouchFl]);
  bench.plant.set_wire_fault(kEstopN, WireFault::kNone);
  EXPECT_TRUE(bench.plant.lines()[kEstopN]);
  bench.plant.press_estop(true);
  EXPECT_FALSE(bench.plant.lines()[kEstopN]);
}

// Where a hardware chain cuts torque, it does so by itself, the brakes hold, and enabling again
// needs the whole walk after the line is back.
TEST(RobotPlant, EstopChainCutsTorque) {
  PlantParams params = gripping_params();
  params.estop_cuts_torque_us = 50'000;
  RobotBench bench(params);
  close_all(bench);
  bench.plant.press_estop(true);
  bench.cycles(5);
  EXPECT_TRUE(has_torque(bench.plant.drive(0).power_state()));
  bench.cycles(2);
  EXPECT_EQ(bench.plant.drive(0).power_state(), PowerState::kSwitchOnDisabled);
  EXPECT_FALSE(bench.plant.truth().fallen);
  EXPECT_TRUE(bench.plant.truth().legs[0].bears);
  bench.cycles(20);
  EXPECT_EQ(bench.plant.drive(0).power_state(), PowerState::kSwitchOnDisabled);
}

struct LossTimes {
  std::int64_t begun_us = -1;     ///< all drives in quick stop
  std::int64_t standing_us = -1;  ///< all at rest
};

/// Time since the last heartbeat, watched every millisecond.
LossTimes watch_loss(RobotBench& bench, std::int64_t last_us) {
  LossTimes times;
  while (bench.now_us - last_us < 400'000) {
    bench.advance(1000);
    bool all_stopped = true, all_stand = true;
    for (int axis = 0; axis < kNumAxes; ++axis) {
      const Drive& drive = bench.plant.drive(axis);
      all_stopped &= drive.power_state() == PowerState::kQuickStopActive;
      all_stand &= drive.motor().velocity_rad_s() == 0.0;
    }
    if (all_stopped && times.begun_us < 0) times.begun_us = bench.now_us - last_us;
    if (all_stopped && all_stand && times.standing_us < 0) {
      times.standing_us = bench.now_us - last_us;
    }
  }
  return times;
}

// The master dies at two hundred random instants of a swinging leg: all sixteen drives begin their
// quick stop within 150 ms + tick after the last heartbeat, stand within 300 ms, nothing is lost.
TEST(RobotPlant, MasterDiesAtAnyInstant) {
  base::Rng rng(11);
  LossTimes worst;
  for (int run = 0; run < 200; ++run) {
    RobotBench bench(gripping_params());
    close_all(bench);
    bench.move_jaw(kFl, 1.2);
    bench.cycles(20);
    bench.move_foot(kFl, {-0.05, 0.15, 0.9 + 0.2 * rng.uniform()});
    bench.cycles(1 + static_cast<int>(rng.below(25)));
    bench.advance(1000 * rng.below(10));
    bench.send(frame_of(0x77F, {0x05}));
    bench.master_alive = false;
    const LossTimes times = watch_loss(bench, bench.now_us);
    ASSERT_GE(times.begun_us, 150'000) << run;
    ASSERT_GE(times.standing_us, 0) << run;
    worst.begun_us = std::max(worst.begun_us, times.begun_us);
    worst.standing_us = std::max(worst.standing_us, times.standing_us);
    ASSERT_FALSE(bench.plant.truth().fallen) << run;
  }
  EXPECT_LE(worst.begun_us, 151'000);
  EXPECT_LE(worst.standing_us, 300'000);
  RecordProperty("worst_begun_us", static_cast<int>(worst.begun_us));
  RecordProperty("worst_standing_us", static_cast<int>(worst.standing_us));
}

std::vector<CarriedFrame> frames_of_a_run(std::uint64_t seed) {
  RobotBench bench(gripping_params(), seed);
  bench.bus.faults(bench.plant.port(4)) = {.loss_share = 0.2, .duplicate_share = 0.1};
  bench.bus.faults(bench.plant.port(7)).jitter_us = 3000;
  close_all(bench);
  bench.plant.inject(5, 0x2310);
  bench.move_foot(kFl, {-0.02, 0.15, 0.95});
  bench.cycles(30);
  return bench.carried;
}

// The same seed gives the same frames, byte by byte and microsecond by microsecond; another seed
// does not.
TEST(RobotPlant, SameSeedSameFrames) {
  const auto same = [](const std::vector<CarriedFrame>& a, const std::vector<CarriedFrame>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const CarriedFrame& x, const CarriedFrame& y) {
                        return x.time_us == y.time_us && x.port == y.port && x.frame == y.frame;
                      });
  };
  const auto first = frames_of_a_run(7);
  EXPECT_GT(first.size(), 1000U);
  EXPECT_TRUE(same(first, frames_of_a_run(7)));
  EXPECT_FALSE(same(first, frames_of_a_run(8)));
}

// A drive whose firmware restarts in the middle of a motion is back with one boot-up frame, and the
// leg stays where its brake caught it.
TEST(RobotPlant, AxisRebootsInMotion) {
  RobotBench bench(gripping_params());
  close_all(bench);
  bench.move_foot(kFl, {-0.03, 0.15, 0.95});
  bench.cycles(3);
  bench.heard.clear();
  bench.plant.reboot(1);
  bench.cycles(5);
  const int boots =
      static_cast<int>(std::count(bench.heard.begin(), bench.heard.end(), frame_of(0x702, {0x00})));
  EXPECT_EQ(boots, 1);
  EXPECT_EQ(bench.plant.drive(1).power_state(), PowerState::kSwitchOnDisabled);
  EXPECT_EQ(bench.plant.drive(0).power_state(), PowerState::kOperationEnabled);
}

// The claw's I/O node reports a force, and "no value" when its sensor is broken.
TEST(RobotPlant, ForceNodesReport) {
  PlantParams params = gripping_params();
  params.has_force_nodes = true;
  RobotBench bench(params);
  close_all(bench);
  const auto last = [&bench] {
    BusFrame found;
    for (const BusFrame& frame : bench.heard) {
      if (frame.id == 0x1A1) found = frame;
    }
    return found;
  };
  EXPECT_EQ(last().length, 6);
  EXPECT_EQ(last().bytes[0], 1);
  EXPECT_GT(signed_number(number_at(last(), 4, 2), 2), 50);  // more than 5 N down
  bench.plant.force_node(0).broken_sensor = true;
  bench.cycles(2);
  EXPECT_EQ(number_at(last(), 2, 2), 0x8000U);
}

}  // namespace
}  // namespace simulator
