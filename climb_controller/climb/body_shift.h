// SPDX-License-Identifier: BSD-3-Clause
// BODY_SHIFT: all four claws hold, the body moves, and turns back to where it should look. One path
// time for all legs, so that they never pull against each other; at its end none does.
#pragma once

#include <Eigen/Geometry>

#include "climb/path_clock.h"

namespace climb {

/// Of the body, in its own frame: first shifted, then turned about its origin.
struct BodyMove {
  Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();

  bool is_none() const { return shift_m.isZero(0.0) && turn.vec().isZero(0.0); }
  Eigen::Isometry3d pose() const {
    Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
    moved.linear() = turn.toRotationMatrix();
    moved.translation() = shift_m;
    return moved;
  }
};

class BodyShift {
 public:
  BodyShift(const RobotParams& robot, const MotionParams& motion);

  /// From where the legs are told to be to where the feet that are `measured` will be seen from the
  /// moved body: what legs pull against each other is given up on the way. False: a foot would come
  /// out of reach.
  bool begin(const PerLeg<LegAngles>& told_rad, const PerLeg<LegAngles>& measured_rad,
             const BodyMove& move);
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
  PerLeg<Eigen::Vector3d> way_m_;
  PerLeg<LegAngles> from_rad_;
  Line line_;  ///< of the part of the way: from 0 to 1 along x
  PathClock clock_;
  bool active_ = false;
};

}  // namespace climb
