// SPDX-License-Identifier: BSD-3-Clause
// Puts solids into a scene, in the coordinates of a stand: origin on the floor beneath the object,
// x away from the robot, y left, z up. `lean` tips what follows about the stand's y axis.
#pragma once

#include <Eigen/Geometry>

#include "base/rng.h"
#include "simulator/scene.h"

namespace simulator {

class SceneBuilder {
 public:
  explicit SceneBuilder(const SceneParams& params);

  /// What is added from now on leans away from the robot by this angle, turned at
  /// kDistanceHeight_m.
  void lean(double angle_deg);

  /// Uniform in [low, high).
  double draw(double low, double high) { return low + (high - low) * rng_.uniform(); }
  int draw_index(int low, int high) {
    return low + static_cast<int>(rng_.below(static_cast<std::uint32_t>(high - low + 1)));
  }

  Solid& box(const Eigen::Vector3d& center_m, const Eigen::Vector3d& half_size_m);
  /// Round rod with flat ends.
  Solid& rod(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m, double radius_m);
  /// Round rod with round ends that reach radius_m beyond from and to.
  Solid& capsule(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m, double radius_m);
  void floor();
  /// A wall across the view whose face is at x = face_m.
  void wall(double face_m);

  /// Enters a rung or bar into the truth list; solids name it by the index returned.
  int true_rung(const Rung& rung_in_stand);
  int true_rail(const Rail& rail_in_stand);

  int num_rungs() const { return static_cast<int>(scene_.rungs.size()); }
  const SceneParams& params() const { return scene_.params; }
  Scene take() { return std::move(scene_); }

 private:
  Solid& add(Solid solid);

  Scene scene_;
  base::Rng rng_;
  Eigen::Isometry3d T_world_stand_;
  Eigen::Isometry3d T_world_part_;
};

/// The kinds of scene_ladders.cpp and scene_negatives.cpp.
void build_ladder_scene(SceneBuilder& builder);
void build_negative_scene(SceneBuilder& builder);

}  // namespace simulator
