// SPDX-License-Identifier: BSD-3-Clause
// The robot on its ladder as the climbing controller meets it: sixteen drives on a bus, four claws,
// touch switches, an E-stop line, an IMU. In virtual time, the same for the same calls.
//
// What carries them is behind mechanics.h; quasi_static.h unless something else is asked for.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include <Eigen/Geometry>

#include "base/rng.h"
#include "simulator/plant/drive.h"
#include "simulator/plant/force_node.h"
#include "simulator/plant/lines.h"
#include "simulator/plant/mechanics.h"
#include "simulator/plant/memory_bus.h"
#include "simulator/plant/plant_params.h"
#include "simulator/plant/rung_world.h"

namespace simulator {

struct ImuReading {
  Eigen::Vector3d specific_force_m_s2 = Eigen::Vector3d::Zero();  ///< body; 0 in free fall
  Eigen::Vector3d angular_rate_rad_s = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_world_body = Eigen::Quaterniond::Identity();
};

/// What a monitor may know and a controller never sees.
struct PlantTruth {
  std::int64_t time_us = 0;
  Eigen::Isometry3d T_world_body = Eigen::Isometry3d::Identity();
  bool docked = false;
  bool fallen = false;
  std::array<LegTruth, kNumLegs> legs;
  std::array<double, kNumAxes> joint_rad{};
  std::array<double, kNumAxes> joint_rad_s{};
  std::array<double, kNumAxes> joint_Nm{};
  std::array<PowerState, kNumAxes> power{};
  LineLevels lines{};
  int num_broken_rungs = 0;
};

using MakeMechanics = std::function<std::unique_ptr<Mechanics>(const PlantParams&)>;

class RobotPlant {
 public:
  /// Attaches its nodes to the bus, which must outlive it. check(params) must be "".
  RobotPlant(const PlantParams& params, MemoryBus& bus);
  /// `make` gets the parameters with the legs' starting angles.
  RobotPlant(const PlantParams& params, MemoryBus& bus, const MakeMechanics& make);

  /// Frames up to now are heard at their times; motors and mechanics move on a grid of 1 ms.
  void advance(std::int64_t now_us);

  /// As they arrive at the controller's end of the wires.
  LineLevels lines() const;
  PlantTruth truth() const;
  ImuReading imu();

  Drive& drive(int axis) { return drives_[static_cast<std::size_t>(axis)]; }
  const Drive& drive(int axis) const { return drives_[static_cast<std::size_t>(axis)]; }
  int port(int axis) const { return drive_ports_[static_cast<std::size_t>(axis)]; }
  const LegTruth& leg(int leg) const { return mechanics_->leg(leg); }
  bool has_force_nodes() const { return !force_nodes_.empty(); }
  ForceNode& force_node(int leg) { return force_nodes_[static_cast<std::size_t>(leg)]; }
  RungWorld& world() { return world_; }
  const RungWorld& world() const { return world_; }
  const Eigen::Isometry3d& T_world_body() const { return mechanics_->body().T_world_body; }

  /// What happens to the robot from outside.
  void set_docked(bool docked) { mechanics_->set_docked(docked); }
  bool is_docked() const { return mechanics_->docked(); }
  void press_estop(bool pressed) { estop_pressed_ = pressed; }
  void set_wire_fault(Line line, WireFault fault) { wires_[line] = fault; }
  void inject(int axis, std::uint16_t fault_code);
  void warn(int axis, std::uint16_t code);
  void clear_warning(int axis);
  void reboot(int axis);
  void drop_to_pre_operational(int axis);

 private:
  void hear_until(std::int64_t until_us);
  void step(std::int64_t now_us);
  void step_nodes(std::int64_t now_us);
  void cut_torque_by_estop();
  void flush(int port, std::int64_t now_us);

  PlantParams params_;
  MemoryBus& bus_;
  RungWorld world_;
  std::unique_ptr<Mechanics> mechanics_;
  std::vector<Drive> drives_;
  std::vector<int> drive_ports_;
  std::vector<ForceNode> force_nodes_;
  std::vector<int> force_ports_;
  std::vector<BusFrame> sent_;
  base::Rng noise_;
  std::int64_t now_us_ = 0;
  std::int64_t next_step_us_ = 0;
  bool estop_pressed_ = false;
  std::int64_t estop_since_us_ = -1;
  std::array<WireFault, kNumLines> wires_{};
};

}  // namespace simulator
