// SPDX-License-Identifier: BSD-3-Clause
#include "climb/mass_model.h"

#include <cmath>

#include <Eigen/Geometry>

namespace climb {

MassModel::MassModel(const RobotParams& robot) : robot_(robot) {
  const MassParams& m = robot.mass;
  total_kg_ = m.torso_kg + kNumLegs * (m.abduction_kg + m.thigh_kg + m.shank_kg + m.claw_kg);
}

Eigen::Vector3d MassModel::center_m(const PerLeg<LegAngles>& angles_rad) const {
  const MassParams& m = robot_.mass;
  Eigen::Vector3d moment_kg_m = Eigen::Vector3d::Zero();  // the torso's middle is the origin
  for (const Leg leg : kLegs) {
    const LegAngles& q = angles_rad[leg];
    const double side_m = lateral_sign(leg) * robot_.abduction_m;
    const Eigen::Vector3d thigh(-std::sin(q[1]), 0.0, -std::cos(q[1]));
    const Eigen::Vector3d shank(-std::sin(q[1] + q[2]), 0.0, -std::cos(q[1] + q[2]));
    const Eigen::Vector3d hip(0.0, side_m, 0.0);
    const Eigen::Vector3d knee = hip + robot_.thigh_m * thigh;
    // Turned by the abduction: half of the offset, middle of thigh and shank, claw at the foot.
    const Eigen::Vector3d turned = m.abduction_kg * 0.5 * hip +
                                   m.thigh_kg * (hip + 0.5 * robot_.thigh_m * thigh) +
                                   m.shank_kg * (knee + 0.5 * robot_.shank_m * shank) +
                                   m.claw_kg * (knee + robot_.shank_m * shank);
    const double leg_kg = m.abduction_kg + m.thigh_kg + m.shank_kg + m.claw_kg;
    const Eigen::Vector3d hip_axis(lengthwise_sign(leg) * robot_.hip_x_m,
                                   lateral_sign(leg) * robot_.hip_y_m, 0.0);
    const double c = std::cos(q[0]);
    const double s = std::sin(q[0]);
    moment_kg_m += leg_kg * hip_axis + Eigen::Vector3d(turned.x(), c * turned.y() - s * turned.z(),
                                                       s * turned.y() + c * turned.z());
  }
  return moment_kg_m / total_kg_;
}

}  // namespace climb
