// SPDX-License-Identifier: BSD-3-Clause
// BODY_SHIFT: all four claws hold, the body moves. One path time for all legs, so that they never
// pull against each other.
#pragma once

#include "climb/path_clock.h"

namespace climb {

class BodyShift {
 public:
  BodyShift(const RobotParams& robot, const MotionParams& motion);

  /// `shift_m` of the body in its own frame. False: a foot would come out of reach on the way.
  bool begin(const PerLeg<LegAngles>& from_rad, const Eigen::Vector3d& shift_m);
  void cancel() { active_ = false; }

  void step(double dt_s, bool stop);
  bool active() const { return active_; }
  double rate() const { return clock_.rate(); }
  JointSample of(Leg leg) const { return sample(leg, clock_.path_time_s()); }

 private:
  JointSample sample(Leg leg, double t_s) const;

  LegKinematics kinematics_;
  MotionParams motion_;
  PerLeg<Eigen::Vector3d> from_m_;
  PerLeg<LegAngles> from_rad_;
  Line line_;
  PathClock clock_;
  bool active_ = false;
};

}  // namespace climb
