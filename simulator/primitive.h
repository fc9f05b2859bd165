// SPDX-License-Identifier: BSD-3-Clause
// One geom as a head sees it: a simple convex body in the head's own frame, in floats, and its
// intersection with a ray that starts at the head. Agrees with MuJoCo's mju_rayGeom, about ten
// times faster.
#pragma once

#include <limits>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <mujoco/mujoco.h>

namespace simulator {

inline constexpr float kMiss = std::numeric_limits<float>::infinity();

struct Primitive {
  enum class Kind { kPlane, kCapsule, kCylinder, kBox };  // a sphere is a capsule without length
  Kind kind = Kind::kBox;
  int geom = -1;
  float reflectance = 0.5F;
  Eigen::Vector3f center_m = Eigen::Vector3f::Zero();
  Eigen::Matrix3f R_head_geom = Eigen::Matrix3f::Identity();  ///< columns: the geom's axes
  Eigen::Vector3f half_size_m = Eigen::Vector3f::Zero();      ///< MuJoCo's geom_size

  Eigen::Vector3f axis() const { return R_head_geom.col(2); }
  /// Half the length of a capsule or cylinder.
  float half_length_m() const { return half_size_m.y(); }
};

/// Distance along the unit ray v from the head to the surface, or kMiss; from inside a body the
/// distance to where the ray leaves it. A plane has only an upper side.
float range_along(const Primitive& primitive, const Eigen::Vector3f& v);

/// Cosine (0..1) between ray and surface normal at that range.
float incidence_cosine(const Primitive& primitive, const Eigen::Vector3f& v, float range_m);

/// Visible geoms (alpha > 0) of the kinds above; meshes, height fields and ellipsoids are left out.
/// Overwrites `primitives`; order of geom ids.
void collect_primitives(const mjModel& model, const mjData& state,
                        const Eigen::Isometry3d& T_world_head, std::vector<Primitive>& primitives);

}  // namespace simulator
