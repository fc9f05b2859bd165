// SPDX-License-Identifier: BSD-3-Clause
// One leg in KDL (Orocos): an independent oracle. Plain numbers at its door, no Eigen.
#pragma once

#include <array>
#include <memory>

namespace kdl_leg {

using Triple = std::array<double, 3>;

struct Shape {
  Triple hip_m{};
  double side_m = 0.0;  ///< from the abduction axis to the hip, to the left
  double thigh_m = 0.0;
  double shank_m = 0.0;
  double claw_rad = 0.0;  ///< claw on the shank, about y
};

struct Pose {
  Triple foot_m{};
  std::array<Triple, 3> claw_axes{};  ///< x, y, z of the claw in the body frame
};

class __attribute__((visibility("default"))) KdlLeg {
 public:
  explicit KdlLeg(const Shape& shape);
  ~KdlLeg();
  Pose forward(const Triple& angles_rad) const;
  /// Columns d foot / d angle.
  std::array<Triple, 3> jacobian(const Triple& angles_rad) const;
  /// Levenberg-Marquardt from `start_rad`, position only; false when it did not converge.
  bool inverse(const Triple& foot_m, const Triple& start_rad, Triple& angles_rad) const;

 private:
  struct Solvers;
  std::unique_ptr<Solvers> solvers_;
};

}  // namespace kdl_leg
