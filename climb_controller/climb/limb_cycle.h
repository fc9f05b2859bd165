// SPDX-License-Identifier: BSD-3-Clause
// One limb through one step, driven by the table of limb_state.h: unload, release, retract,
// transit, approach, close, verify, load; again, or back to the old rung. The body stands still
// meanwhile, so all points are in the body frame. Whether the limb may be lifted is not asked here.
#pragma once

#include <optional>

#include <Eigen/Geometry>

#include "climb/foot_line.h"
#include "climb/grasp_confirmation.h"
#include "climb/limb_state.h"
#include "climb/path_clock.h"

namespace climb {

/// Where to grasp, body frame.
struct LimbGoal {
  int rung_id = -1;
  Eigen::Vector3d pregrasp_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d grasp_m = Eigen::Vector3d::Zero();
};

struct LimbInput {
  LegAngles angles_rad = LegAngles::Zero();  ///< measured
  LegAngles torques_Nm = LegAngles::Zero();
  ClawReading claw;
  /// By the other feet: on the ladder the body gives way when this one pulls.
  Eigen::Isometry3d T_odom_body = Eigen::Isometry3d::Identity();
  bool stop = false;  ///< slow down along the path and stand
  double dt_s = 0.01;
};

struct LimbTarget {
  LegAngles angles_rad = LegAngles::Zero();
  LegAngles velocity_rad_s = LegAngles::Zero();
  double jaw_rad = 0.0;
  double weight = 0.0;  ///< 0 = bears nothing .. 1 = its full share
};

struct LimbParams {
  double jaw_speed_rad_s = 5.0;    ///< of the jaw's target (own)
  double close_timeout_s = 2.0;    ///< without touch (contract)
  double budget_s = 20.0;          ///< of all tries (contract)
  int max_tries = 3;               ///< on one rung: the first and two more (contract)
  double try_offset_m = 0.010;     ///< along the rung, one to the left, one to the right (contract)
  double empty_window_rad = 0.06;  ///< a jaw so near its stop has closed on nothing (own)
};

class LimbCycle {
 public:
  LimbCycle(const RobotParams& robot, const MotionParams& motion, const LimbParams& params,
            const ConfirmationParams& confirmation, Leg leg);

  /// Stands where it is measured, nothing planned. `holds`: as confirmed before, and still closed.
  void reset(const LimbInput& measured, bool holds);

  /// The next step, or from the dock the first grasp. False: not in this state.
  bool begin(const LimbGoal& goal);

  /// Back to the old rung, where that is still possible (before the rung is touched).
  bool abort() { return take(LimbEvent::kAbort); }

  /// One cycle; target() is new afterwards.
  void step(const LimbInput& input);

  /// While LOADED the body may be moved: targets come from outside.
  void follow(const JointSample& sample, double rate);

  LimbState state() const { return state_; }
  const LimbTarget& target() const { return target_; }
  const GraspConfirmation& confirmation() const { return confirmation_; }
  GraspWitness last_witness() const { return last_witness_; }
  int rung_id() const { return held_rung_id_; }  ///< of the last confirmed grasp
  const LimbGoal& goal() const { return goal_; }
  bool moves() const { return moves_; }  ///< between begin() and LOADED
  bool returned() const { return returned_; }
  bool failed() const { return failed_; }  ///< no grasp, not even on the old rung
  void close_jaw() { is_jaw_forced_ = true; }

 private:
  bool take(LimbEvent event);
  void enter(LimbState from);
  void work(const LimbInput& input);
  void move_foot(const Eigen::Vector3d& to_m, double speed_m_s);
  void move_joints(const LegAngles& to_rad, double min_duration_s);
  bool advance(const LimbInput& input);
  void move_jaw(const LimbInput& input);
  void finish_closing(const LimbInput& input);
  void finish_pull(const LimbInput& input);
  void stay_home();
  void return_home(const LimbInput& input);
  bool is_open(const LimbInput& input) const;
  double path_part() const;
  Eigen::Vector3d approach_offset_m() const;

  LegKinematics kinematics_;
  LegLimits limits_;
  ClawParams claw_;
  MotionParams motion_;
  LimbParams params_;
  Leg leg_;
  GraspConfirmation confirmation_;

  LimbState state_ = LimbState::kPregrasp;
  LimbTarget target_;
  LimbInput input_;
  LimbGoal goal_;
  std::optional<LimbGoal> home_;  ///< the old rung
  std::optional<FootLine> line_;  ///< the path, if straight; else segment_
  JointSegment segment_;
  PathClock clock_;
  double jaw_goal_rad_ = 0.0;
  double in_state_s_ = 0.0;
  double spent_s_ = 0.0;
  int num_tries_ = 0;
  int stage_ = 0;  ///< of a path in two parts
  int held_rung_id_ = -1;
  bool moves_ = false;
  bool returned_ = false;
  bool failed_ = false;
  bool is_jaw_forced_ = false;
  GraspWitness last_witness_;
  Eigen::Vector3d pulled_from_m_ = Eigen::Vector3d::Zero();  ///< odom
  LegAngles torques_before_Nm_ = LegAngles::Zero();
};

}  // namespace climb
