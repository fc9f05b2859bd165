// SPDX-License-Identifier: BSD-3-Clause
// Which limb goes next and where: in the dock each free claw to the rung before it, on the ladder
// the crawl. Goals come out in the body frame as it stands.
#pragma once

#include <array>

#include "climb/body_shift.h"
#include "climb/controller_io.h"
#include "climb/step_order.h"

namespace climb {

struct PlannedStep {
  Leg leg = kRearRight;
  bool upwards = true;
  bool ready = false;                ///< goal (and shift) are set
  bool at_top = false;               ///< both front claws hold the highest trusted rung
  bool at_dock = false;              ///< on the way down: all claws where they were in the dock
  Refusal refusal = Refusal::kNone;  ///< when not ready
  Burden burden = Burden::kBorne;    ///< when not ready and nothing is refused
  BodyMove move;                     ///< of the body, before the step
  LimbGoal goal;                     ///< body frame, after the shift
  double joint_margin_rad = 0.0;     ///< of that leg on its way
};

/// What the planner needs to know of the robot now.
struct RobotNow {
  Stance stance;  ///< measured, with the weights
  PerLeg<LimbState> limbs{};
  OdometryEstimate pose;
};

/// A limb in the air that found no grasp, or whose target is seen elsewhere by now.
struct Retry {
  enum class Where : std::uint8_t { kThere, kBeside, kOtherRung };
  Leg leg = kRearRight;
  bool upwards = true;
  Where where = Where::kThere;
  int tried_rung_id = -1;
  Eigen::Vector3d tried_m = Eigen::Vector3d::Zero();  ///< odom
  Eigen::Vector3d from_m = Eigen::Vector3d::Zero();   ///< odom, where it was held
};

/// How far the search for another way has come.
struct WaySearch {
  enum class Stage : std::uint8_t {
    kNone,
    kStep,      ///< the refused step, from other places of the body
    kFirst,     ///< a step of another leg before it
    kStepThen,  ///< the refused step, after that
    kMateThen,  ///< and the next one of its pair
  };
  Stage stage = Stage::kNone;
  int num_places = 0;       ///< of the body, to either side
  int place = 0;            ///< the next to be looked at, -num_places to num_places
  PlannedStep best;         ///< until now; as it was refused: none
  double best_worth = 0.0;  ///< of its place [rad]
  PlannedStep first;        ///< found in kFirst
  RobotNow then;            ///< ... and where that leads
};

class StepPlanner {
 public:
  static constexpr int kPlacesACycle = 4;  ///< of the body, looked at in a call of over()

  explicit StepPlanner(const ClimbParams& params);

  /// A free limb to the rung nearest before it; not to one that gave way under it (-1 = none did).
  PlannedStep dock(Leg leg, int avoid_rung_id, const RobotNow& now, const LadderView& ladder);

  /// No rung is seen for a free limb on the ladder, as `refused` says: where the other of its pair
  /// holds one, it goes on to this leg's side, unless it looks damaged.
  PlannedStep beside(const PlannedStep& refused, const RobotNow& now, const LadderView& ladder);

  /// The next step of the crawl, with the body shift that it wants first (zero: it is in place).
  /// may_shift false: from where the body is.
  PlannedStep next(bool upwards, bool may_shift, const RobotNow& now, const LadderView& ladder);

  /// Where next() is refused: from another place of the body (the shift comes first), over a rung
  /// that is none to grasp, or another leg before it. Else as it was refused. Called in each cycle,
  /// as the robot stands: it looks at a few places a call and answers when it has seen all, after
  /// 31 calls at most; the call after that begins anew.
  std::optional<PlannedStep> over(const PlannedStep& refused, bool may_shift, const RobotNow& now,
                                  const LadderView& ladder);
  void forget_way() { way_.stage = WaySearch::Stage::kNone; }

  /// The rung at this place (odom) does not hold: no step goes there, until the next order.
  void remember_vain(const Eigen::Vector3d& place_m);
  void forget_vain() { num_vain_ = 0; }

  /// After vain tries at `tried` (odom): another place on that rung or, if `other_rung`, another
  /// one.
  PlannedStep again(const Retry& retry, const RobotNow& now, const LadderView& ladder);

  /// Where the claws held in the dock, odom.
  void remember_dock(const RobotNow& now);
  bool is_at_dock(const RobotNow& now) const;

  /// The nearest of `places` (body frame) that carries the robot once this limb in the air holds it
  /// too, beside the claws that still do; none = none does.
  std::optional<LimbGoal> put_down(Leg leg, const RobotNow& now,
                                   std::span<const LimbGoal> places) const;

  /// Does the ladder still offer this place (odom) on that rung?
  bool offers(int rung_id, const Eigen::Vector3d& place_m, const LadderView& ladder) const;

  /// Four claws on four rungs, any one of which may break without a fall.
  bool rests_safely(const RobotNow& now) const;

  /// From where a claw in the dock looks upwards for its first rung, odom.
  Eigen::Vector3d docked_from_m(Leg leg, const RobotNow& now) const;

  /// Armed on the ladder: which step was the last, the feet tell.
  void find_turn(const RobotNow& now);

  /// The step was made: the next leg is on. On the way back the last one goes first.
  void made(Leg leg, bool upwards) {
    last_leg_ = leg;
    last_upwards_ = upwards;
    forget_way();
  }

 private:
  Leg next_leg_of(bool upwards) const;
  bool has_stepped(Leg leg, bool upwards, const RobotNow& now) const;
  GraspQuery query_of(Leg leg, bool upwards, const RobotNow& now) const;
  BodyMove body_move(double ahead_m, const RobotNow& now) const;
  PlannedStep choose(GraspQuery query, const RobotNow& now, const LadderView& ladder);
  void look_for(WaySearch::Stage stage, const PlannedStep& wanted, bool may_shift);
  void look_from(double ahead_m, const RobotNow& now, const LadderView& ladder);
  std::optional<PlannedStep> conclude(const PlannedStep& refused, bool may_shift,
                                      const RobotNow& now);
  RobotNow after_step(const PlannedStep& step, const Stance& moved, const RobotNow& now) const;
  BodyMove as_far_as_all_reach(const BodyMove& move, const RobotNow& now) const;
  /// No leg is nearly straight or at a joint's limit, where a small error of place is a large one
  /// of its joints.
  bool all_bend(const Stance& stance) const;
  std::optional<Stance> stance_after(const BodyMove& move, const RobotNow& now) const;
  double spacing_m(const LadderView& ladder) const;
  bool is_at_top(const RobotNow& now, const LadderView& ladder) const;
  bool goes_on_above(const RungView& top, const RobotNow& now, const LadderView& ladder) const;

  ClimbParams params_;
  LegKinematics kinematics_;
  Support support_;
  GraspChoice choice_;
  Leg last_leg_ = kFrontLeft;
  bool last_upwards_ = true;
  std::optional<PerLeg<Eigen::Vector3d>> dock_feet_m_;
  std::array<Eigen::Vector3d, 4> vain_m_;  ///< odom
  std::size_t num_vain_ = 0;
  WaySearch way_;
};

}  // namespace climb
