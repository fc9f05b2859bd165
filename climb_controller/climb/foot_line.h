// SPDX-License-Identifier: BSD-3-Clause
// A straight line of a foot in the body frame as a path of joint angles: approach and retraction.
// The whole line is checked when it is made, and slowed down where a joint would be too fast.
#pragma once

#include "climb/leg_trajectory.h"

namespace climb {

struct LineSpeed {
  double max_m_s = 0.05;
  double max_m_s2 = 1.0;
};

class FootLine {
 public:
  FootLine(const LegKinematics& kinematics, Leg leg, const Eigen::Vector3d& from_body_m,
           const Eigen::Vector3d& to_body_m, const LineSpeed& speed);

  /// kReachable, or why not at the first checked point that is not.
  Reach reach() const { return reach_; }
  /// 0 for a line that cannot be followed.
  double duration_s() const { return line_.duration_s(); }
  /// A line that cannot be followed stands at its start (at zero when that has no solution).
  JointSample at(double t_s) const;

 private:
  JointSample sample(const LegAngles& angles_rad, const LineSample& foot) const;
  /// Of joint speeds and accelerations to their limits: the factor by which it is too fast.
  double haste();

  LegKinematics kinematics_;
  Leg leg_;
  LegLimits limits_;
  Line line_;
  Reach reach_ = Reach::kNotFinite;
  LegAngles start_rad_ = LegAngles::Zero();
};

}  // namespace climb
