// SPDX-License-Identifier: BSD-3-Clause
// A rigid motion. T_to_from maps coordinates of `from` into `to`.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace tof {

struct Pose {
  Eigen::Vector3d p_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();  ///< unit
};

/// Coordinates finite and within 10 km, quaternion of length 1 within 1e-3.
bool is_sound(const Pose& pose);

/// T_a_c = T_a_b * T_b_c.
Pose operator*(const Pose& T_a_b, const Pose& T_b_c);

/// Linear in position; the quaternion linear and then normalised (nlerp: within 0.1 deg of the
/// great circle when the ends are 30 deg apart). fraction 0 = a, 1 = b; beyond 1 extrapolates.
Pose interpolate(const Pose& a, const Pose& b, double fraction);

/// The same for directions. Returns b when they cancel.
Eigen::Vector3d interpolate(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double fraction);

/// The smallest rotation that takes unit vector `from` to unit vector `to`. For opposite vectors
/// any half turn does; a fixed one is returned.
Eigen::Quaterniond smallest_rotation(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace tof
