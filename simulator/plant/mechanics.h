// SPDX-License-Identifier: BSD-3-Clause
// What stands between the drives' motors and the ladder: body, legs, claws, contact. Two kinds:
// quasi_static.h, light enough for thousands of runs, and physics/, MuJoCo with real contacts.
// The drives, the bus and the lines (robot_plant.h) are the same for both.
#pragma once

#include <cstdint>
#include <span>

#include <Eigen/Geometry>

#include "simulator/plant/claw.h"
#include "simulator/plant/drive.h"
#include "simulator/plant/rung_world.h"

namespace simulator {

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

struct BodyMotion {
  Eigen::Isometry3d T_world_body = Eigen::Isometry3d::Identity();
  Eigen::Vector3d angular_rate_rad_s = Eigen::Vector3d::Zero();   ///< body frame
  Eigen::Vector3d specific_force_m_s2 = Eigen::Vector3d::Zero();  ///< body frame; 0 in free fall
};

class Mechanics {
 public:
  virtual ~Mechanics() = default;
  /// Once, before the first step.
  virtual void take_over(std::span<Drive> drives) = 0;
  /// One step of the grid (Drive::kStep_us): moves the joints as the drives command, breaks rungs
  /// that are due or overloaded. `drives` holds kNumAxes elements.
  virtual void step(std::int64_t now_us, std::span<Drive> drives, RungWorld& world) = 0;
  virtual const BodyMotion& body() const = 0;
  virtual const LegTruth& leg(int leg) const = 0;
  virtual bool fallen() const = 0;
  /// The operator's dock holds the body where it is now, or lets it go.
  virtual void set_docked(bool docked) = 0;
  virtual bool docked() const = 0;
};

}  // namespace simulator
