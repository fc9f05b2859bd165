// SPDX-License-Identifier: BSD-3-Clause
// The robot on its ladder as the climbing controller meets it: sixteen drives on a bus, four claws,
// touch switches, an E-stop line, an IMU. In virtual time, the same for the same calls.
//
// Quasi-static and honest about it. Modelled: drives with lag, limits, torque saturation; claws
// that catch and lose rungs; forces as stiffness times what the commanded foot lies off its
// contact, plus its share of the weight; joints that bend under them; a body that goes where its
// feet hold it; rungs that break; a fall when fewer than two feet hold. NOT modelled: inertia and
// swing of the body, sag under weight, slip, friction, fingers or knees bumping into rungs,
// self-collision, bending rungs, servo heat, ground contact.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "base/rng.h"
#include "simulator/plant/body_pose.h"
#include "simulator/plant/claw.h"
#include "simulator/plant/drive.h"
#include "simulator/plant/force_node.h"
#include "simulator/plant/lines.h"
#include "simulator/plant/memory_bus.h"
#include "simulator/plant/plant_params.h"
#include "simulator/plant/rung_world.h"

namespace simulator {

struct ImuReading {
  Eigen::Vector3d specific_force_m_s2 = Eigen::Vector3d::Zero();  ///< body; 0 in free fall
  Eigen::Vector3d angular_rate_rad_s = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_world_body = Eigen::Quaterniond::Identity();
};

struct LegTruth {
  bool holds = false;
  bool bears = false;  ///< holds, and all its joints are held by torque or brake
  bool touch = false;  ///< the switch, before any wire fault
  int rung_index = -1;
  Eigen::Vector3d p_world_foot_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d force_on_rung_N = Eigen::Vector3d::Zero();
  LossCause last_loss = LossCause::kNone;
  std::int64_t lost_us = -1;
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
  std::array<PowerState, kNumAxes> power{};
  LineLevels lines{};
  int num_broken_rungs = 0;
};

class RobotPlant {
 public:
  /// Attaches its nodes to the bus, which must outlive it. check(params) must be "".
  RobotPlant(const PlantParams& params, MemoryBus& bus);

  /// Frames up to now are heard at their times; motors and mechanics move on a grid of 1 ms.
  void advance(std::int64_t now_us);

  /// As they arrive at the controller's end of the wires.
  LineLevels lines() const;
  PlantTruth truth() const;
  ImuReading imu();

  Drive& drive(int axis) { return drives_[static_cast<std::size_t>(axis)]; }
  const Drive& drive(int axis) const { return drives_[static_cast<std::size_t>(axis)]; }
  int port(int axis) const { return drive_ports_[static_cast<std::size_t>(axis)]; }
  const Claw& claw(int leg) const { return claws_[static_cast<std::size_t>(leg)]; }
  bool has_force_nodes() const { return !force_nodes_.empty(); }
  ForceNode& force_node(int leg) { return force_nodes_[static_cast<std::size_t>(leg)]; }
  RungWorld& world() { return world_; }
  const RungWorld& world() const { return world_; }
  const Eigen::Isometry3d& T_world_body() const { return T_world_body_; }

  /// What happens to the robot from outside.
  void set_docked(bool docked);
  bool is_docked() const { return docked_; }
  void press_estop(bool pressed) { estop_pressed_ = pressed; }
  void set_wire_fault(Line line, WireFault fault) { wires_[line] = fault; }
  void inject(int axis, std::uint16_t fault_code);
  void warn(int axis, std::uint16_t code);
  void clear_warning(int axis);
  void reboot(int axis);
  void drop_to_pre_operational(int axis);

 private:
  void place_legs();
  void hear_until(std::int64_t until_us);
  void step(std::int64_t now_us);
  void step_nodes(std::int64_t now_us);
  void step_claws();
  void step_body();
  void weigh(unsigned bearing);
  void step_loads();
  void load_leg(int leg, bool bearing);
  void step_rungs();
  void fall();
  void cut_torque_by_estop();
  void flush(int port, std::int64_t now_us);
  LegAngles leg_angles(int leg, bool deflected) const;
  bool bears(int leg) const;
  int num_bearing() const;

  PlantParams params_;
  MemoryBus& bus_;
  RungWorld world_;
  std::vector<Drive> drives_;
  std::vector<int> drive_ports_;
  std::vector<ForceNode> force_nodes_;
  std::vector<int> force_ports_;
  std::vector<Claw> claws_;
  std::vector<BusFrame> sent_;
  base::Rng noise_;
  std::int64_t now_us_ = 0;
  std::int64_t next_step_us_ = 0;
  Eigen::Isometry3d T_world_body_ = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_world_dock_ = Eigen::Isometry3d::Identity();
  Eigen::Vector3d angular_rate_rad_s_ = Eigen::Vector3d::Zero();
  std::array<Eigen::Vector3d, kNumLegs> force_on_rung_N_;
  std::array<Eigen::Vector3d, kNumLegs> weight_share_N_;
  unsigned weighed_legs_ = ~0U;  ///< bearing legs for which weight_share_N_ was computed, by bits
  std::int64_t weighed_us_ = 0;
  bool docked_ = false;
  bool fallen_ = false;
  double fall_m_s_ = 0.0;
  bool estop_pressed_ = false;
  std::int64_t estop_since_us_ = -1;
  std::array<WireFault, kNumLines> wires_{};
};

}  // namespace simulator
