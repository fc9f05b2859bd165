// SPDX-License-Identifier: BSD-3-Clause
// The controller's own CiA 402 master against the plant: two sides of one wire contract, written
// without looking at each other's code.
#include <vector>

#include <gtest/gtest.h>

#include "can/cia402_bus.h"
#include "robot_in_a_box/memory_transport.h"
#include "simulator/plant/monitor.h"
#include "simulator/plant/robot_plant.h"

namespace simulator {
namespace {

can::Cia402Params master_params(const PlantParams& plant) {
  can::Cia402Params params;
  for (int axis = 0; axis < kNumAxes; ++axis) {
    const MonitorParams rules(plant);
    const AxisRules& rule = rules.rules[static_cast<std::size_t>(axis)];
    can::AxisConfig config;
    config.node_id = static_cast<std::uint8_t>(axis + 1);
    config.min_rad = rule.min_rad;
    config.max_rad = rule.max_rad;
    config.max_velocity_rad_s = rule.max_velocity_rad_s;
    if (is_jaw(axis)) {
      config.rated_torque_Nm = config.max_torque_Nm = 6.0;
      config.following_error_rad = 0.5;  // a jaw on a rung never reaches its target
    }
    params.axes.push_back(config);
  }
  return params;
}

struct MasterBench {
  explicit MasterBench(const PlantParams& params = {})
      : plant(params, bus),
        transport(bus),
        monitor(MonitorParams(params)),
        master(master_params(params), transport),
        feedback(kNumAxes),
        targets(kNumAxes) {
    bus.record(true);
  }
  /// One control cycle in virtual time, polled every millisecond.
  void cycle() {
    for (int i = 0; i < 10; ++i) {
      now_us += 1000;
      plant.advance(now_us);
      transport.set_time(now_us);
      if (i < 9) master.poll(now_us);
    }
    can::Targets all;
    all.time_us = now_us;
    if (master.phase() == can::BusPhase::kEnabled) all.axes = targets;
    master.exchange(now_us, all, feedback);
    for (std::size_t axis = 0; axis < targets.size() && all.axes.empty(); ++axis) {
      targets[axis].position_rad = feedback[axis].position_rad;
    }
    for (const CarriedFrame& carried : bus.take_carried()) monitor.on_frame(carried);
    monitor.on_truth(plant.truth());
  }
  bool reach(can::BusPhase wanted, int max_cycles = 1000) {
    for (int i = 0; i < max_cycles && master.phase() != wanted; ++i) cycle();
    return master.phase() == wanted;
  }
  std::string problems() const {
    std::string text;
    for (const can::ObjectIssue& issue : master.issues()) text += can::describe(issue) + "\n";
    for (const can::Fault& fault : master.faults()) {
      text += std::string(can::name(fault.cause)) + " axis " + std::to_string(fault.axis) + "\n";
    }
    for (const Violation& violation : monitor.violations()) text += describe(violation) + "\n";
    return text;
  }

  MemoryBus bus;
  RobotPlant plant;
  robot_in_a_box::MemoryTransport transport;
  Monitor monitor;
  can::Cia402Bus master;
  std::vector<can::AxisFeedback> feedback;
  std::vector<can::AxisTarget> targets;
  std::int64_t now_us = 0;
};

// From power-up: sixteen axes are configured with every object read back, enabled at the measured
// position, moved, and disabled, without a fault on either side or a word from the monitor.
TEST(Master, BringsSixteenAxesUp) {
  MasterBench bench;
  for (int i = 0; i < 5; ++i) bench.cycle();
  ASSERT_TRUE(bench.master.configure());
  ASSERT_TRUE(bench.reach(can::BusPhase::kReady)) << bench.problems();
  EXPECT_TRUE(bench.master.capabilities().hold_on_loss);
  EXPECT_TRUE(bench.master.capabilities().torque_limit);
  bench.monitor.on_session(bench.now_us, SessionEvent::kArmed);
  ASSERT_TRUE(bench.master.enable());
  ASSERT_TRUE(bench.reach(can::BusPhase::kEnabled)) << bench.problems();
  for (int i = 0; i < 20; ++i) {
    bench.targets[1].position_rad += 0.01;
    bench.cycle();
  }
  for (int i = 0; i < 40; ++i) bench.cycle();
  EXPECT_NEAR(bench.plant.drive(1).measured_rad(), bench.targets[1].position_rad, 2e-4);
  EXPECT_NEAR(bench.feedback[1].position_rad, bench.targets[1].position_rad, 3e-4);
  EXPECT_TRUE(bench.master.faults().empty()) << bench.problems();
  ASSERT_TRUE(bench.master.disable());
  EXPECT_TRUE(bench.reach(can::BusPhase::kReady));
  EXPECT_EQ(bench.problems(), "");
  EXPECT_EQ(bench.master.num_malformed(), 0U);
}

// Drives without 6007h, 6072h and 6077h: the master names the missing objects and has no hold on
// loss.
TEST(Master, SeesMissingObjects) {
  PlantParams params;
  for (DriveParams& drive : params.drives) {
    drive.objects = {.abort_connection_option = false, .max_torque = false, .torque_actual = false};
  }
  MasterBench bench(params);
  for (int i = 0; i < 5; ++i) bench.cycle();
  ASSERT_TRUE(bench.master.configure());
  for (int i = 0; i < 1000; ++i) bench.cycle();
  EXPECT_FALSE(bench.master.capabilities().hold_on_loss);
  EXPECT_NE(bench.problems().find("6007h"), std::string::npos) << bench.problems();
}

// A drive that reboots in motion is a fault to the master within a cycle.
TEST(Master, SeesAReboot) {
  MasterBench bench;
  for (int i = 0; i < 5; ++i) bench.cycle();
  bench.master.configure();
  ASSERT_TRUE(bench.reach(can::BusPhase::kReady)) << bench.problems();
  bench.monitor.on_session(bench.now_us, SessionEvent::kArmed);
  bench.master.enable();
  ASSERT_TRUE(bench.reach(can::BusPhase::kEnabled)) << bench.problems();
  bench.plant.reboot(6);
  for (int i = 0; i < 6; ++i) bench.cycle();
  ASSERT_FALSE(bench.master.faults().empty());
  EXPECT_EQ(bench.master.faults().front().axis, 6);
}

}  // namespace
}  // namespace simulator
