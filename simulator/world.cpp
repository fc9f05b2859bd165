// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/world.h"

#include <array>

#include "base/check.h"
#include "simulator/mjcf.h"

namespace simulator {
namespace {

mjModel* compile(const Scene& scene) {
  const std::array<MjcfFile, 1> files = {{{"scene.xml", to_mjcf(scene)}}};
  return compile_mjcf(files);
}

}  // namespace

World::World(const Scene& scene)
    : scene_(scene), model_(compile(scene)), state_(mj_makeData(model_.get())) {
  CHECK(state_ != nullptr, "MuJoCo has no memory for the state");
  mj_forward(model_.get(), state_.get());
  rung_of_geom_.assign(static_cast<std::size_t>(model_->ngeom), -1);
  for (std::size_t i = 0; i < scene.solids.size(); ++i) {
    const int geom = mj_name2id(model_.get(), mjOBJ_GEOM, solid_name(i).c_str());
    CHECK(geom >= 0, "every solid became a geom");
    if (scene.solids[i].part == Part::kRung) rung_of_geom_[geom] = scene.solids[i].part_index;
  }
}

}  // namespace simulator
