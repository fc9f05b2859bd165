// SPDX-License-Identifier: BSD-3-Clause
// Which point of which rung a leg grasps next: every rung is accepted or refused with a reason, the
// cheapest accepted one wins, ties go to the lower id. Reach is checked before the grasp, on the
// way, at it, and after the next body shift. Whether the other limbs bear the robot meanwhile is
// Support's question.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "climb/leg_kinematics.h"
#include "climb/params.h"

namespace climb {

/// One rung as perceived, odom frame.
struct RungView {
  int id = 0;
  bool trusted = false;
  bool damaged = false;  ///< any flag: stub, bent, sagged, tilted
  double confidence = 0.0;
  Eigen::Vector3d end0_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d end1_m = Eigen::Vector3d::Zero();
  double radius_m = 0.0;
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();
};

/// A stretch of a rung where a gripper's middle may be (perception already kept it off rails and
/// outliers); refused stretches are not passed on.
struct StretchView {
  int rung_index = 0;   ///< into LadderView::rungs
  double from_m = 0.0;  ///< from end 0
  double to_m = 0.0;
};

struct LadderView {
  std::span<const RungView> rungs;
  std::span<const StretchView> stretches;
  double age_s = 0.0;      ///< since receipt
  bool confirmed = false;  ///< it is a ladder
};

/// A claw that holds, odom frame.
struct HeldPoint {
  bool holds = false;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
};

struct GraspQuery {
  Leg leg = kFrontLeft;
  bool upwards = true;  ///< along the body's x axis; false = back down
  Eigen::Isometry3d T_odom_body = Eigen::Isometry3d::Identity();  ///< at the time of the grasp
  double body_sigma_m = 0.0;
  Eigen::Vector3d next_shift_m = Eigen::Vector3d::Zero();  ///< odom; body shift after this step
  PerLeg<HeldPoint> held;
  Eigen::Vector3d from_m = Eigen::Vector3d::Zero();  ///< odom, where this foot is now, or was held
  int avoid_rung_id = -1;                            ///< tried in vain
  int only_rung_id = -1;                             ///< no other is looked at
  std::optional<Eigen::Vector3d> avoid_m;            ///< odom; nothing nearer than retry_distance_m
  bool is_long = false;                              ///< a rung on the way may be left out
  std::span<const Eigen::Vector3d> vain_m;           ///< odom; the rungs there do not hold
};

enum class Refusal : std::uint8_t {
  kNone,
  kNotFinite,
  kStale,
  kNoLadder,
  kAvoided,
  kNotTrusted,
  kDamaged,
  kLowConfidence,
  kRadius,
  kUncertain,  ///< position error above max_sigma_m
  kNotAhead,   ///< behind, or the rung it is on
  kTooFarAhead,
  kNoStretch,        ///< no stretch of the rung may be grasped
  kStretchTooShort,  ///< narrower than claw and margin
  kTooFarSideways,
  kOccupied,  ///< another claw is too near
  kPregraspOutOfReach,
  kApproachOutOfReach,
  kGraspOutOfReach,
  kShiftOutOfReach,
  kJointMargin,
  kSingular,
  kRungMissing  ///< none a step away, but one at twice that: a rung is missing between, or unseen
};
inline constexpr int kNumRefusals = static_cast<int>(Refusal::kRungMissing) + 1;

const char* name(Refusal refusal);

struct GraspTarget {
  int rung_id = -1;
  Eigen::Vector3d grasp_m = Eigen::Vector3d::Zero();     ///< odom, on the rung's axis
  Eigen::Vector3d pregrasp_m = Eigen::Vector3d::Zero();  ///< odom, along the claw's opening
  Eigen::Vector3d rung_axis = Eigen::Vector3d::UnitY();  ///< odom, unit, to the robot's left
  double radius_m = 0.0;                                 ///< of the rung
  double sigma_m = 0.0;
  double joint_margin_rad = 0.0;  ///< least on the way
  double cost_m = 0.0;
};

struct RungDecision {
  int rung_id = -1;
  Refusal refusal = Refusal::kNone;
};

/// Valid until the next choose().
struct GraspDecision {
  /// kNone = target is set; else the refusal of the rung that is a step away, or where none is, of
  /// the one that came farthest.
  Refusal refusal = Refusal::kNoLadder;
  GraspTarget target;
  std::span<const RungDecision> rungs;  ///< parallel to LadderView::rungs
};

class GraspChoice {
 public:
  /// Rungs beyond max_rungs are not looked at.
  GraspChoice(const ClimbParams& params, int max_rungs = 256);

  GraspDecision choose(const LadderView& ladder, const GraspQuery& query);

 private:
  Refusal judge(const LadderView& ladder, int rung_index, const GraspQuery& query,
                GraspTarget& target) const;
  /// Along the ladder, from where the leg is, in the way it goes.
  static double step_to_m(const RungView& rung, const GraspQuery& query);
  double longest_step_m(const GraspQuery& query) const {
    return query.is_long ? params_.max_long_step_m : params_.max_step_m;
  }
  bool is_within_step(const RungView& rung, const GraspQuery& query) const;
  bool is_vain(const RungView& rung, const GraspQuery& query) const;
  bool lacks_rung(const LadderView& ladder, const GraspQuery& query) const;
  Refusal judge_rung(const RungView& rung, const GraspQuery& query, GraspTarget& target) const;
  Refusal place(const LadderView& ladder, int rung_index, const GraspQuery& query,
                GraspTarget& target) const;
  Refusal judge_place(const GraspQuery& query, const GraspTarget& target) const;
  Refusal judge_reach(const GraspQuery& query, const GraspTarget& target,
                      double& joint_margin_rad) const;
  Refusal judge_posture(const GraspQuery& query, const LegAngles& angles_rad,
                        double& joint_margin_rad) const;
  double cost_m(const RungView& rung, const GraspQuery& query, const GraspTarget& target,
                double joint_margin_rad) const;

  LegKinematics kinematics_;
  MotionParams motion_;
  ClawParams claw_;
  GraspChoiceParams params_;
  int max_rungs_;
  std::vector<RungDecision> decisions_;
};

}  // namespace climb
