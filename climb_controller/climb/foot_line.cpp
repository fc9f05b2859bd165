// SPDX-License-Identifier: BSD-3-Clause
#include "climb/foot_line.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace climb {
namespace {

constexpr int kNumChecks = 64;           ///< points of a line: 1 mm apart on the usual 60 mm
constexpr double kBetweenChecks = 1.02;  ///< what a joint may be faster between two of them

}  // namespace

FootLine::FootLine(const LegKinematics& kinematics, Leg leg, const Eigen::Vector3d& from_body_m,
                   const Eigen::Vector3d& to_body_m, const LineSpeed& speed)
    : kinematics_(kinematics),
      leg_(leg),
      limits_(leg_limits(kinematics, leg)),
      line_(from_body_m, to_body_m, speed.max_m_s, speed.max_m_s2) {
  const LegSolution start = kinematics_.inverse(leg, from_body_m);
  if (start.reachable()) start_rad_ = start.angles_rad;
  const double slower = line_.valid() ? haste() : 1.0;
  if (!line_.valid() || reach_ != Reach::kReachable) {
    line_ = Line();
    return;
  }
  if (slower > 1.0) {
    line_ = Line(from_body_m, to_body_m, speed.max_m_s, speed.max_m_s2,
                 line_.duration_s() * slower * kBetweenChecks);
  }
}

double FootLine::haste() {
  double worst = 1.0;
  for (int i = 0; i <= kNumChecks; ++i) {
    const LineSample foot = line_.at(line_.duration_s() * i / kNumChecks);
    const LegSolution solution = kinematics_.inverse(leg_, foot.point_m);
    reach_ = solution.reach;
    if (!solution.reachable()) return worst;
    const JointSample joints = sample(solution.angles_rad, foot);
    for (int joint = 0; joint < kNumLegJoints; ++joint) {
      const double speed =
          std::abs(joints.velocity_rad_s[joint]) / limits_[joint].max_velocity_rad_s;
      const double acceleration =
          std::abs(joints.acceleration_rad_s2[joint]) / limits_[joint].max_acceleration_rad_s2;
      worst = std::max({worst, speed, std::sqrt(acceleration)});
    }
  }
  return worst;
}

JointSample FootLine::at(double t_s) const {
  if (reach_ != Reach::kReachable) return {start_rad_};
  const LineSample foot = line_.at(t_s);
  const LegSolution solution = kinematics_.inverse(leg_, foot.point_m);
  return solution.reachable() ? sample(solution.angles_rad, foot) : JointSample{start_rad_};
}

JointSample FootLine::sample(const LegAngles& angles_rad, const LineSample& foot) const {
  // J q' = v and J q'' = a - J' q', with J' along the motion by central difference.
  constexpr double kStep_s = 1e-5;
  const Eigen::Matrix3d inverse = kinematics_.jacobian(leg_, angles_rad).inverse();
  const LegAngles velocity = inverse * foot.velocity_m_s;
  const Eigen::Matrix3d turning = (kinematics_.jacobian(leg_, angles_rad + kStep_s * velocity) -
                                   kinematics_.jacobian(leg_, angles_rad - kStep_s * velocity)) /
                                  (2.0 * kStep_s);
  return {angles_rad, velocity, inverse * (foot.acceleration_m_s2 - turning * velocity)};
}

}  // namespace climb
