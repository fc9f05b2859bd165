// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/mjcf.h"

#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>

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
  return text + " 1\" contype=\"2\" conaffinity=\"1\" friction=\"0.8 0.01 0.001\"/>\n";
}

}  // namespace

std::string solid_name(std::size_t index) {
  return "solid" + std::to_string(index);
}

std::string to_mjcf(const Scene& scene, const std::string& include) {
  std::string text = "<mujoco model=\"";
  text += to_string(scene.params.kind);
  text += "\">\n  <compiler angle=\"radian\"/>\n";
  if (!include.empty()) text += "  <include file=\"" + include + "\"/>\n";
  text += "  <worldbody>\n";
  for (std::size_t i = 0; i < scene.solids.size(); ++i) text += geom_element(scene.solids[i], i);
  return text + "  </worldbody>\n</mujoco>\n";
}

mjModel* compile_mjcf(std::span<const MjcfFile> files) {
  const auto folder = std::make_unique<mjVFS>();  // too large for the stack
  mj_defaultVFS(folder.get());
  for (std::size_t i = 0; i < files.size(); ++i) {
    const MjcfFile& file = files[i];
    if (mj_makeEmptyFileVFS(folder.get(), file.name.c_str(), static_cast<int>(file.text.size())) !=
        0) {
      throw std::runtime_error("MuJoCo: no room for " + file.name);
    }
    std::memcpy(folder->filedata[i], file.text.data(), file.text.size());
  }
  char error[500] = "";
  mjModel* model = mj_loadXML(files.front().name.c_str(), folder.get(), error, sizeof error);
  mj_deleteVFS(folder.get());
  if (model == nullptr) throw std::runtime_error(std::string("MuJoCo: ") + error);
  return model;
}

}  // namespace simulator
