// SPDX-License-Identifier: BSD-3-Clause
// Where the body is when springs hold it at its feet (and at the dock): the rigid pose of least
// energy, and how the weight is shared by the feet. Quasi-static: no masses move.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace simulator {

/// A spring between a point of the body and a point of the world.
struct Support {
  Eigen::Vector3d p_body_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d p_world_m = Eigen::Vector3d::Zero();
  double stiffness_N_m = 0.0;  ///< > 0
};

/// The pose that minimises the sum of stiffness * distance^2 (Horn 1987, unit quaternions).
/// Directions that the supports leave free stay as `previous` has them.
Eigen::Isometry3d balanced_pose(std::span<const Support> supports,
                                const Eigen::Isometry3d& previous);

/// Forces [N, world] that the contacts exert on the robot to bear its weight at the centre of mass:
/// the least sum of squares that balances force and moment as far as they can. Zero without
/// contacts.
std::vector<Eigen::Vector3d> weight_shares(std::span<const Eigen::Vector3d> contacts_m,
                                           const Eigen::Vector3d& centre_of_mass_m,
                                           double weight_N);

}  // namespace simulator
