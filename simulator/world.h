// SPDX-License-Identifier: BSD-3-Clause
// A scene as a MuJoCo model with its state. The heads render any model's geoms; which geom belongs
// to which true rung is kept here. Nothing moves here; the robot in
// physics stands in physics/.
#pragma once

#include <memory>
#include <vector>

#include <mujoco/mujoco.h>

#include "simulator/scene.h"

namespace simulator {

class World {
 public:
  /// Throws std::runtime_error with MuJoCo's message when the model does not compile.
  explicit World(const Scene& scene);

  const mjModel& model() const { return *model_; }
  const mjData& state() const { return *state_; }
  const Scene& scene() const { return scene_; }
  /// Index into scene().rungs, or -1, per geom id.
  const std::vector<int>& rung_of_geom() const { return rung_of_geom_; }

 private:
  struct DeleteModel {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
  };
  struct DeleteState {
    void operator()(mjData* state) const { mj_deleteData(state); }
  };

  Scene scene_;
  std::unique_ptr<mjModel, DeleteModel> model_;
  std::unique_ptr<mjData, DeleteState> state_;
  std::vector<int> rung_of_geom_;
};

}  // namespace simulator
