// SPDX-License-Identifier: BSD-3-Clause
// The robot in physics (MuJoCo): masses, torque-limited servos, claws that hold because their
// fingers touch the rung. Drives command it, contacts answer.
// Not modelled: see robot.xml; and a rung breaks off at once and is gone, it neither bends nor
// falls as a body.
#pragma once

#include <array>
#include <vector>

#include "simulator/physics/physics_model.h"
#include "simulator/plant/mechanics.h"
#include "simulator/plant/plant_params.h"

namespace simulator {

class PhysicsMechanics : public Mechanics {
 public:
  /// `model` must outlive it, is moved to the starting pose, and has one rung per rung of params.
  PhysicsMechanics(const PlantParams& params, PhysicsModel& model);

  void take_over(std::span<Drive> drives) override;
  void step(std::int64_t now_us, std::span<Drive> drives, RungWorld& world) override;
  const BodyMotion& body() const override { return body_; }
  const LegTruth& leg(int leg) const override { return legs_[static_cast<std::size_t>(leg)]; }
  bool fallen() const override { return fallen_; }
  void set_docked(bool docked) override;
  bool docked() const override { return docked_; }

 private:
  struct Hold {
    Eigen::Vector3d force_on_rung_N = Eigen::Vector3d::Zero();
    int rung = -1;
    double strongest_N = 0.0;
    std::int64_t contact_us = -1;  ///< the last time a rung was touched
    std::int64_t pressed_us = -1;  ///< since when the switch is pressed
  };

  void place(const PlantParams& params);
  void command(std::span<const Drive> drives);
  void observe(std::span<Drive> drives) const;
  void sum_contact_forces();
  void tell_leg(int leg, std::span<const Drive> drives, const RungWorld& world);
  void tell_body();
  void break_rungs(RungWorld& world);
  void judge_fall();

  PlantParams params_;
  PhysicsModel& model_;
  BodyMotion body_;
  std::array<LegTruth, kNumLegs> legs_;
  std::array<Hold, kNumLegs> holds_;
  std::vector<double> load_N_;  ///< per rung
  std::vector<char> touched_;
  std::array<double, kNumAxes> frictionloss_Nm_{};
  std::int64_t now_us_ = 0;
  std::int64_t unheld_us_ = -1;
  bool docked_ = false;
  bool fallen_ = false;
};

}  // namespace simulator
