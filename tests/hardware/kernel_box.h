// SPDX-License-Identifier: BSD-3-Clause
// The climbing robot on kernel devices: the live service's control cycle with its CAN socket and
// its GPIO chip on one side, the plant on the other side of interface and chip, both in this
// process and in real time. Rungs come from truth. The twin in virtual time is
// robot_in_a_box/climb_box.h.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "can/can_socket.h"
#include "can/cia402_bus.h"
#include "climb_controller/control_cycle.h"
#include "climb_controller/drive_layout.h"
#include "gpio/lines.h"
#include "robot_in_a_box/perceived_ladder.h"
#include "simulator/plant/bus_hub.h"
#include "simulator/plant/line_hub.h"
#include "simulator/plant/monitor.h"

namespace hardware {

struct KernelBoxParams {
  std::string controller_interface = "vcan0";
  std::string plant_interface = "vcan0";
  std::string chip_folder;  ///< of gpio-sim in sysfs
  std::int64_t cycle_us = 10'000;
  simulator::PlantParams plant;
};

class KernelBox {
 public:
  explicit KernelBox(const KernelBoxParams& params);
  KernelBox(const KernelBox&) = delete;
  KernelBox& operator=(const KernelBox&) = delete;

  /// Up to and including the next cycle of the controller; the plant runs on meanwhile.
  void cycle();
  void run_s(double duration_s);
  bool reach(climb::ControllerState wanted, double within_s);
  /// Until it is answered. With this run's session and the next number.
  climb::CommandVerdict order(climb::Order what);

  /// Once, before the plant's first step at or after this time.
  void at(std::int64_t time_us, std::function<void()> happen);

  climb::ControllerState state() const { return report_.output.state; }
  climb::Fault reason() const { return report_.output.reason; }
  const climb_controller::CycleReport& report() const { return report_; }
  simulator::RobotPlant& plant() { return plant_; }
  robot_in_a_box::PerceivedLadder& perception() { return perception_; }
  const simulator::Monitor& monitor() const { return monitor_; }
  /// State, reasons, faults of the bus and what the monitor saw.
  std::string problems() const;

  /// The controller's clock.
  std::int64_t now_us() const;
  /// Of the last frame that only a master sends, as it arrived at the plant.
  std::int64_t master_heard_us() const { return master_heard_us_; }

  int num_cycles = 0;
  int num_overruns = 0;  ///< begun more than a period late
  std::int64_t worst_late_us = 0;

 private:
  void wait();
  void step_plant();
  void step_controller();
  void tell_monitor();

  KernelBoxParams params_;
  std::int64_t start_us_;
  simulator::MemoryBus bus_;
  simulator::RobotPlant plant_;
  simulator::BusHub hub_;
  simulator::SimulatedChip wires_;
  simulator::Monitor monitor_;
  robot_in_a_box::PerceivedLadder perception_;

  can::CanSocket socket_;
  can::FlightRecorder recorder_;
  can::Cia402Bus master_;
  std::unique_ptr<gpio::LineChip> chip_;
  gpio::Lines lines_;
  climb_controller::ControlCycle cycle_;
  climb_controller::CycleInbox inbox_;
  climb_controller::CycleReport report_;
  climb::OperatorCommand command_;
  std::int64_t seq_ = 0;
  std::int64_t due_us_ = 0;
  std::int64_t master_heard_us_ = 0;
  std::int64_t happens_us_ = 0;
  std::function<void()> happen_;
  climb::ControllerState told_state_ = climb::ControllerState::kBoot;
  std::int64_t told_seq_ = -1;
};

}  // namespace hardware
