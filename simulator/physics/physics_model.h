// SPDX-License-Identifier: BSD-3-Clause
// The robot (robot.xml) and a scene in one MuJoCo model, and which of its elements are what.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include <mujoco/mujoco.h>

#include "simulator/plant/plant_kinematics.h"
#include "simulator/scene.h"

namespace simulator {

class PhysicsModel {
 public:
  /// Throws std::runtime_error with MuJoCo's message when the model does not compile.
  explicit PhysicsModel(const Scene& scene);

  const mjModel& model() const { return *model_; }
  mjModel& model() { return *model_; }
  const mjData& state() const { return *state_; }
  mjData& state() { return *state_; }

  struct Joint {
    int position = -1;  ///< index into qpos
    int velocity = -1;  ///< index into qvel and the dof arrays
    int actuator = -1;
  };
  const Joint& joint(int axis) const { return joints_[static_cast<std::size_t>(axis)]; }
  int torso_body() const { return torso_body_; }
  int dock() const { return dock_; }
  int foot_site(int leg) const { return foot_sites_[static_cast<std::size_t>(leg)]; }
  /// The leg whose claw or jaw this geom belongs to, or -1.
  int leg_of_claw_geom(int geom) const { return claw_leg_[static_cast<std::size_t>(geom)]; }
  /// Index into scene.rungs, or -1.
  int rung_of_geom(int geom) const { return rung_[static_cast<std::size_t>(geom)]; }
  const std::vector<int>& rung_of_geom() const { return rung_; }
  /// Gone for contacts and for every ray.
  void remove_rung(int rung);

 private:
  struct Delete {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
    void operator()(mjData* state) const { mj_deleteData(state); }
  };
  int find(mjtObj kind, const std::string& name) const;

  std::unique_ptr<mjModel, Delete> model_;
  std::unique_ptr<mjData, Delete> state_;
  std::array<Joint, kNumAxes> joints_;
  std::array<int, kNumLegs> foot_sites_{};
  int torso_body_ = -1;
  int dock_ = -1;
  std::vector<int> claw_leg_;
  std::vector<int> rung_;
};

}  // namespace simulator
