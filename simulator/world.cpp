// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/world.h"

#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "base/check.h"

namespace simulator {
namespace {

const char* mjcf_type(Shape shape) {
  switch (shape) {
    case Shape::kPlane:
      return "plane";
    case Shape::kSphere:
      return "sphere";
    case Shape::kCapsule:
      return "capsule";
    case Shape::kCylinder:
      return "cylinder";
    case Shape::kBox:
      return "box";
  }
  return "";
}

std::string solid_name(std::size_t index) {
  return "solid" + std::to_string(index);
}

/// Nine digits: far below a pixel, and the last bits of libm's sine do not reach the model.
void append_numbers(std::string& text, const Eigen::Vector3d& values) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, " %.9g %.9g %.9g", values.x(), values.y(), values.z());
  text += buffer;
}

std::string geom_element(const Solid& solid, std::size_t index) {
  std::string text = "    <geom name=\"" + solid_name(index) + "\" type=\"";
  text += mjcf_type(solid.shape);
  text += "\" size=\"";
  append_numbers(text,
                 solid.shape == Shape::kPlane ? Eigen::Vector3d(0.0, 0.0, 1.0) : solid.half_size_m);
  text += "\" pos=\"";
  append_numbers(text, solid.center_m);
  text += "\" xyaxes=\"";
  append_numbers(text, solid.R_world_solid.col(0));
  append_numbers(text, solid.R_world_solid.col(1));
  text += "\" rgba=\"";
  append_numbers(text, Eigen::Vector3d::Constant(solid.reflectance));
  return text + " 1\"/>\n";
}

mjModel* compile(const std::string& mjcf) {
  constexpr const char* kFileName = "scene.xml";
  const auto files = std::make_unique<mjVFS>();  // too large for the stack
  mj_defaultVFS(files.get());
  if (mj_makeEmptyFileVFS(files.get(), kFileName, static_cast<int>(mjcf.size())) != 0) {
    throw std::runtime_error("MuJoCo: no room for the scene's XML");
  }
  std::memcpy(files->filedata[0], mjcf.data(), mjcf.size());
  char error[500] = "";
  mjModel* model = mj_loadXML(kFileName, files.get(), error, sizeof error);
  mj_deleteVFS(files.get());
  if (model == nullptr) throw std::runtime_error(std::string("MuJoCo: ") + error);
  return model;
}

}  // namespace

std::string to_mjcf(const Scene& scene) {
  std::string text = "<mujoco model=\"";
  text += to_string(scene.params.kind);
  text += "\">\n  <compiler angle=\"radian\"/>\n  <worldbody>\n";
  for (std::size_t i = 0; i < scene.solids.size(); ++i) text += geom_element(scene.solids[i], i);
  return text + "  </worldbody>\n</mujoco>\n";
}

World::World(const Scene& scene)
    : scene_(scene), model_(compile(to_mjcf(scene))), state_(mj_makeData(model_.get())) {
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
