// SPDX-License-Identifier: BSD-3-Clause
// Which limb goes next and where: in the dock each free claw to the rung before it, on the ladder
// the crawl. Goals come out in the body frame as it stands.
#pragma once

#include "climb/controller_io.h"
#include "climb/step_order.h"

namespace climb {

struct PlannedStep {
  Leg leg = kRearRight;
  bool ready = false;
  bool at_top = false;               ///< both front claws hold the highest trusted rung
  Refusal refusal = Refusal::kNone;  ///< when not ready
  Burden burden = Burden::kBorne;    ///< when not ready and nothing is refused
  Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();  ///< of the body, body frame, before the step
  LimbGoal goal;                                      ///< body frame, after the shift
};

/// What the planner needs to know of the robot now.
struct RobotNow {
  Stance stance;  ///< measured, with the weights
  PerLeg<LimbState> limbs{};
  OdometryEstimate pose;
};

class StepPlanner {
 public:
  explicit StepPlanner(const ClimbParams& params);

  /// A free limb to the rung nearest before it.
  PlannedStep dock(Leg leg, const RobotNow& now, const LadderView& ladder);

  /// The next step of the crawl. `shifted`: the body is already where the step wants it.
  PlannedStep next(bool upwards, bool shifted, const RobotNow& now, const LadderView& ladder);

  /// The step was made (or given up): the next leg is on.
  void made(Leg leg) { last_leg_ = leg; }

 private:
  PlannedStep choose(GraspQuery query, const RobotNow& now, const LadderView& ladder);
  /// Body shift that brings the body back to its stand-off and between its feet, body frame.
  Eigen::Vector3d centring_m(const RobotNow& now) const;
  double spacing_m(const LadderView& ladder) const;
  bool is_at_top(const RobotNow& now, const LadderView& ladder) const;

  ClimbParams params_;
  LegKinematics kinematics_;
  Support support_;
  GraspChoice choice_;
  Leg last_leg_ = kFrontLeft;
};

}  // namespace climb
