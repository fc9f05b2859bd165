// SPDX-License-Identifier: BSD-3-Clause
// What sensor_service takes for the robot's limbs is where the limbs of the robot in physics are.
#include "tof/limbs.h"

#include <gtest/gtest.h>

#include "base/rng.h"
#include "simulator/physics/physics_model.h"

namespace simulator {
namespace {

double distance_m(const Eigen::Vector3d& p, const tof::Capsule& capsule) {
  const Eigen::Vector3d along = capsule.to_m - capsule.from_m;
  const double share =
      std::clamp((p - capsule.from_m).dot(along) / std::max(along.squaredNorm(), 1e-12), 0.0, 1.0);
  return (p - capsule.from_m - share * along).norm();
}

/// For random joint angles every capsule of thigh, shank, claw and jaw lies within the filter's,
/// without its margin to within a millimetre.
TEST(Limbs, ContainTheLimbsOfTheRobotInPhysics) {
  SceneParams scene;
  PhysicsModel model(make_scene(scene));
  tof::LimbParams params;
  params.margin_m = 0.0;
  base::Rng rng(3);
  const mjModel& m = model.model();
  mjData& state = model.state();
  for (int i = 0; i < 50; ++i) {
    tof::JointAngles angles{};
    for (int axis = 0; axis < kNumAxes; ++axis) {
      const double span = is_jaw(axis) ? 0.9 : 0.8;
      angles[static_cast<std::size_t>(axis)] = span * (2.0 * rng.uniform() - 1.0);
      state.qpos[model.joint(axis).position] = angles[static_cast<std::size_t>(axis)];
    }
    mj_kinematics(&m, &state);
    const tof::Limbs limbs = tof::limbs_of(params, angles);
    const Eigen::Map<const Eigen::Vector3d> torso(state.xpos + 3 * model.torso_body());
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> attitude(
        state.xmat + 9 * model.torso_body());
    int num_geoms = 0;
    for (int geom = 0; geom < m.ngeom; ++geom) {
      const std::string body = mj_id2name(&m, mjOBJ_BODY, m.geom_bodyid[geom]);
      const bool is_limb = body.starts_with("thigh") || body.starts_with("shank") ||
                           body.starts_with("claw") || body.starts_with("jaw");
      if (!is_limb) continue;
      ++num_geoms;
      const Eigen::Map<const Eigen::Vector3d> centre(state.geom_xpos + 3 * geom);
      const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R(state.geom_xmat +
                                                                             9 * geom);
      for (const double side : {-1.0, 1.0}) {
        const Eigen::Vector3d end =
            attitude.transpose() * (centre + side * m.geom_size[3 * geom + 1] * R.col(2) - torso);
        double outside_m = 1.0;
        for (const tof::Capsule& limb : limbs) {
          outside_m =
              std::min(outside_m, distance_m(end, limb) + m.geom_size[3 * geom] - limb.radius_m);
        }
        EXPECT_LT(outside_m, 1e-3) << body;
      }
    }
    EXPECT_EQ(num_geoms, 4 * 10);
  }
}

}  // namespace
}  // namespace simulator
