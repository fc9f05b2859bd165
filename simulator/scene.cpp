// SPDX-License-Identifier: BSD-3-Clause
// Names of scenes, the check of their parameters, and the builder that places solids.
#include "simulator/scene.h"

#include <cmath>
#include <stdexcept>

#include "base/check.h"
#include "simulator/scene_builder.h"

namespace simulator {
namespace {

constexpr double kRadPerDeg = 0.017453292519943295;

Eigen::Isometry3d rotation(double angle_deg, const Eigen::Vector3d& axis) {
  return Eigen::Isometry3d(Eigen::AngleAxisd(angle_deg * kRadPerDeg, axis));
}

/// Any rotation whose z axis is `direction`.
Eigen::Matrix3d frame_along(const Eigen::Vector3d& direction) {
  Eigen::Matrix3d frame;
  const Eigen::Vector3d z = direction.normalized();
  const Eigen::Vector3d aside =
      std::abs(z.x()) < 0.9 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  const Eigen::Vector3d y = z.cross(aside).normalized();
  frame << y.cross(z), y, z;
  return frame;
}

bool within(double value, double low, double high) {
  return value >= low && value <= high;
}

}  // namespace

SceneKind scene_kind_from_string(std::string_view name) {
  if (name == "normal") return SceneKind::kPlain;
  std::string known;
  for (const SceneName& entry : kSceneNames) {
    if (entry.name == name) return entry.kind;
    known += known.empty() ? "" : ", ";
    known += entry.name;
  }
  throw std::invalid_argument("unknown scene \"" + std::string(name) + "\"; known are " + known);
}

std::string_view to_string(SceneKind kind) {
  for (const SceneName& entry : kSceneNames) {
    if (entry.kind == kind) return entry.name;
  }
  return "unknown";
}

bool is_ladder(SceneKind kind) {
  return kind < SceneKind::kEmptyRoom ||
         (kind >= SceneKind::kLoose && kind < SceneKind::kNarrowShelf);
}

RungSection rung_section_from_string(std::string_view name) {
  if (name == "round") return RungSection::kRound;
  if (name == "oval") return RungSection::kOval;
  if (name == "flat_top") return RungSection::kFlatTop;
  if (name == "tread") return RungSection::kTread;
  throw std::invalid_argument("unknown section of rungs \"" + std::string(name) +
                              "\"; known are round, oval, flat_top, tread");
}

std::string check(const SceneParams& params) {
  if (!within(params.distance_m, 0.3, 3.0)) return "distance_m must be in [0.3, 3]";
  if (!within(params.yaw_deg, -60.0, 60.0)) return "yaw_deg must be in [-60, 60]";
  if (params.rung_diameter_m && !within(*params.rung_diameter_m, 0.01, 0.12)) {
    return "rung_diameter_m must be in [0.01, 0.12]";
  }
  if (params.rail_diameter_m && !within(*params.rail_diameter_m, 0.01, 0.12)) {
    return "rail_diameter_m must be in [0.01, 0.12]";
  }
  if (!within(params.rail_width_m, 0.002, 0.12)) return "rail_width_m must be in [0.002, 0.12]";
  if (params.wall_reflectance && !within(*params.wall_reflectance, 0.01, 1.0)) {
    return "wall_reflectance must be in [0.01, 1]";
  }
  if (!within(params.spacing_m, 0.15, 0.5)) return "spacing_m must be in [0.15, 0.5]";
  if (!within(params.clear_width_m, 0.2, 0.8)) return "clear_width_m must be in [0.2, 0.8]";
  if (params.num_rungs < 1 || params.num_rungs > 16) return "num_rungs must be in [1, 16]";
  return "";
}

Scene make_scene(const SceneParams& params) {
  if (const std::string problem = check(params); !problem.empty()) {
    throw std::invalid_argument("scene: " + problem);
  }
  SceneBuilder builder(params);
  builder.floor();
  if (is_ladder(params.kind)) {
    build_ladder_scene(builder);
  } else {
    build_negative_scene(builder);
  }
  return builder.take();
}

Scene without_rung(Scene scene, int index) {
  CHECK(index >= 0 && index < static_cast<int>(scene.rungs.size()), "the scene has this rung");
  std::erase_if(scene.solids, [index](const Solid& solid) {
    return solid.part == Part::kRung && solid.part_index == index;
  });
  for (Solid& solid : scene.solids) {
    if (solid.part == Part::kRung && solid.part_index > index) --solid.part_index;
  }
  scene.rungs.erase(scene.rungs.begin() + index);
  return scene;
}

SceneBuilder::SceneBuilder(const SceneParams& params)
    : rng_(params.seed, static_cast<std::uint64_t>(params.kind)),
      T_world_stand_(Eigen::Translation3d(params.distance_m, draw(-0.03, 0.03), 0.0) *
                     rotation(params.yaw_deg, Eigen::Vector3d::UnitZ())),
      T_world_part_(T_world_stand_) {
  scene_.params = params;
}

void SceneBuilder::lean(double angle_deg) {
  const Eigen::Translation3d hinge(0.0, 0.0, kDistanceHeight_m);
  T_world_part_ =
      T_world_stand_ * hinge * rotation(angle_deg, Eigen::Vector3d::UnitY()) * hinge.inverse();
}

Solid& SceneBuilder::add(Solid solid) {
  solid.center_m = T_world_part_ * solid.center_m;
  solid.R_world_solid = T_world_part_.linear() * solid.R_world_solid;
  scene_.solids.push_back(solid);
  return scene_.solids.back();
}

Solid& SceneBuilder::box(const Eigen::Vector3d& center_m, const Eigen::Vector3d& half_size_m) {
  Solid solid;
  solid.shape = Shape::kBox;
  solid.center_m = center_m;
  solid.half_size_m = half_size_m;
  return add(solid);
}

Solid& SceneBuilder::rod(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m,
                         double radius_m) {
  Solid solid;
  solid.shape = Shape::kCylinder;
  solid.center_m = 0.5 * (from_m + to_m);
  solid.R_world_solid = frame_along(to_m - from_m);
  solid.half_size_m = {radius_m, 0.5 * (to_m - from_m).norm(), 0.0};
  return add(solid);
}

Solid& SceneBuilder::capsule(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m,
                             double radius_m) {
  Solid& solid = rod(from_m, to_m, radius_m);
  solid.shape = Shape::kCapsule;
  return solid;
}

void SceneBuilder::floor() {
  Solid solid;
  solid.shape = Shape::kPlane;
  solid.reflectance = draw(0.3, 0.6);
  add(solid);
}

void SceneBuilder::wall(double face_m) {
  const double drawn = draw(0.4, 0.8);
  box({face_m + 0.05, 0.0, 1.5}, {0.05, 2.5, 1.5}).reflectance =
      params().wall_reflectance.value_or(drawn);
}

int SceneBuilder::true_rung(const Rung& rung_in_stand) {
  Rung rung = rung_in_stand;
  rung.end0_m = T_world_part_ * rung.end0_m;
  rung.end1_m = T_world_part_ * rung.end1_m;
  scene_.rungs.push_back(rung);
  return static_cast<int>(scene_.rungs.size()) - 1;
}

int SceneBuilder::true_rail(const Rail& rail_in_stand) {
  Rail rail = rail_in_stand;
  rail.end0_m = T_world_part_ * rail.end0_m;
  rail.end1_m = T_world_part_ * rail.end1_m;
  scene_.rails.push_back(rail);
  return static_cast<int>(scene_.rails.size()) - 1;
}

}  // namespace simulator
