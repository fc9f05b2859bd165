// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/physics/physics_model.h"

#include <algorithm>
#include <string>

#include "base/check.h"
#include "simulator/mjcf.h"
#include "simulator/physics/robot_xml.h"

namespace simulator {
namespace {

constexpr std::array<const char*, kJointsPerLeg> kJointNames = {"abduction", "hip", "knee", "jaw"};

std::string joint_name(int axis) {
  return std::string(kJointNames[static_cast<std::size_t>(joint_of(axis))]) +
         kLegNames[static_cast<std::size_t>(leg_of(axis))];
}

/// Rungs with round ends: MuJoCo knows two capsules' contact in closed form, a cylinder's only by
/// search, and their ends are in the rails anyway. A broken end keeps its place.
Scene with_round_ends(Scene scene) {
  for (Solid& solid : scene.solids) {
    if (solid.part != Part::kRung || solid.shape != Shape::kCylinder) continue;
    solid.shape = Shape::kCapsule;
    solid.half_size_m.y() = std::max(0.0, solid.half_size_m.y() - solid.half_size_m.x());
  }
  return scene;
}

mjModel* compile(const Scene& scene) {
  const std::string scene_xml = to_mjcf(with_round_ends(scene), "robot.xml");
  const std::array<MjcfFile, 2> files = {{{"scene.xml", scene_xml}, {"robot.xml", kRobotXml}}};
  return compile_mjcf(files);
}

}  // namespace

PhysicsModel::PhysicsModel(const Scene& scene)
    : model_(compile(scene)), state_(mj_makeData(model_.get())) {
  CHECK(state_ != nullptr, "MuJoCo has no memory for the state");
  for (int axis = 0; axis < kNumAxes; ++axis) {
    const int id = find(mjOBJ_JOINT, joint_name(axis));
    joints_[static_cast<std::size_t>(axis)] = {model_->jnt_qposadr[id], model_->jnt_dofadr[id],
                                               find(mjOBJ_ACTUATOR, joint_name(axis))};
  }
  torso_body_ = find(mjOBJ_BODY, "torso");
  dock_ = find(mjOBJ_EQUALITY, "dock");
  claw_leg_.assign(static_cast<std::size_t>(model_->ngeom), -1);
  for (int leg = 0; leg < kNumLegs; ++leg) {
    const std::string name = kLegNames[static_cast<std::size_t>(leg)];
    foot_sites_[static_cast<std::size_t>(leg)] = find(mjOBJ_SITE, "foot" + name);
    const int claw = find(mjOBJ_BODY, "claw" + name);
    const int jaw = find(mjOBJ_BODY, "jaw" + name);
    for (int geom = 0; geom < model_->ngeom; ++geom) {
      const int body = model_->geom_bodyid[geom];
      if (body == claw || body == jaw) claw_leg_[static_cast<std::size_t>(geom)] = leg;
    }
  }
  rung_.assign(static_cast<std::size_t>(model_->ngeom), -1);
  for (std::size_t i = 0; i < scene.solids.size(); ++i) {
    if (scene.solids[i].part != Part::kRung) continue;
    rung_[static_cast<std::size_t>(find(mjOBJ_GEOM, solid_name(i)))] = scene.solids[i].part_index;
  }
}

int PhysicsModel::find(mjtObj kind, const std::string& name) const {
  const int id = mj_name2id(model_.get(), kind, name.c_str());
  CHECK(id >= 0, ("robot.xml has no element " + name).c_str());
  return id;
}

void PhysicsModel::remove_rung(int rung) {
  for (int geom = 0; geom < model_->ngeom; ++geom) {
    if (rung_of_geom(geom) != rung) continue;
    model_->geom_contype[geom] = 0;
    model_->geom_conaffinity[geom] = 0;
    model_->geom_rgba[4 * geom + 3] = 0.0F;
  }
}

}  // namespace simulator
