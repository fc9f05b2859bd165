// SPDX-License-Identifier: BSD-3-Clause
// One limb through one step, driven by the table of limb_state.h: unload, release, retract,
// transit, approach, close, verify, load; again, elsewhere, or back to the old rung; each of it in
// bounded time. Points are in the body frame; the body gives way a little while the limb is off, so
// they are put right by odometry before each way. Whether the
// limb may be lifted, and where else to try, is not decided here.
#pragma once

#include <optional>
#include <string>

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
  double radius_m = 0.0;                            ///< of the rung; 0 = not known
  Eigen::Vector3d axis = Eigen::Vector3d::UnitY();  ///< of the rung, unit
  bool is_beyond = false;  ///< a rung that may be there is passed on the way
};

/// The same place, told in another frame.
LimbGoal moved(const Eigen::Isometry3d& T_to_from, const LimbGoal& goal);

struct LimbInput {
  LegAngles angles_rad = LegAngles::Zero();  ///< measured
  LegAngles torques_Nm = LegAngles::Zero();
  ClawReading claw;
  /// By the other feet: on the ladder the body gives way when this one pulls.
  Eigen::Isometry3d T_odom_body = Eigen::Isometry3d::Identity();
  bool stop = false;        ///< slow down along the path and stand
  bool follows = true;      ///< drives follow targets, so a jaw that holds also presses
  bool others_hold = true;  ///< the three others, in this very cycle: else it is not released
  bool docked = false;      ///< a dock bears the body: claws may open all the same
  double dt_s = 0.01;
};

struct LimbTarget {
  LegAngles angles_rad = LegAngles::Zero();
  LegAngles velocity_rad_s = LegAngles::Zero();
  double jaw_rad = 0.0;
  double weight = 0.0;  ///< 0 = bears nothing .. 1 = its full share
};

/// What a claw has, when drives begin to follow.
enum class Hold : std::uint8_t {
  kNone,
  kConfirmed,  ///< by this controller, and still closed
  kFelt        ///< it is closed round something that can be a rung
};

struct LimbParams {
  double jaw_speed_rad_s = 5.0;    ///< of the jaw's target (own)
  double close_timeout_s = 2.0;    ///< without touch (contract)
  double open_timeout_s = 1.0;     ///< for a jaw to stand open (own: it takes 0.35)
  double press_again_s = 0.3;      ///< for a held claw's touch after re-arming (own: takes 0.1)
  double others_timeout_s = 0.5;   ///< for the others to hold before it is released (own)
  double budget_s = 20.0;          ///< of all tries, from when the first rung is reached; then once
                                   ///< more from when it turns back (contract)
  int max_tries = 3;               ///< at the first place: as planned and two more (contract)
  int max_tries_elsewhere = 1;     ///< at each further place: the budget allows no more (own)
  double try_offset_m = 0.010;     ///< across the rung, one above, one below (contract)
  double empty_window_rad = 0.06;  ///< a jaw so near its stop has closed on nothing (own)
};

/// "" or the violated relation, naming the field.
std::string check(const LimbParams& params);

class LimbCycle {
 public:
  LimbCycle(const RobotParams& robot, const MotionParams& motion, const LimbParams& params,
            const ConfirmationParams& confirmation, Leg leg);

  /// Stands where it is measured, nothing planned.
  void reset(const LimbInput& measured, Hold hold);

  /// Of a claw that was felt: it is pulled at where it is, beside what it bears. It stays closed.
  bool prove();
  bool needs_proof() const { return needs_proof_; }
  bool is_doubtful() const { return is_doubtful_; }  ///< pulled at in vain
  void fail() { failed_ = true; }                    ///< it stands there for good

  /// The next step, or from the dock the first grasp. False: not in this state.
  bool begin(const LimbGoal& goal);

  /// Off its rung and open, to stay so: in the dock, before the drives are switched off.
  bool park();

  /// Back to the old rung, where that is still possible (before the rung is touched).
  bool abort() { return take(LimbEvent::kAbort); }

  /// Its target is seen a little elsewhere by now (body frame). For a limb that is under way to it:
  /// the path it is on is finished, the next one leads there.
  void aim_at(const LimbGoal& goal);

  /// The tries at this place are used up: the answer is retarget() or give_up().
  bool wants_goal() const { return wants_goal_; }
  void retarget(const LimbGoal& goal);
  void give_up();  ///< back to the old rung, if there is one

  /// From the air down to `goal`, whatever was planned. A limb at a rung goes on with that, one
  /// that is not off its old rung yet closes again.
  void put_down(const LimbGoal& goal);

  /// One cycle; target() is new afterwards.
  void step(const LimbInput& input);

  /// While LOADED the body may be moved: targets come from outside.
  void follow(const JointSample& sample, double rate);

  /// While LOADED, in the dock: the leg lets go, little by little, what it bears.
  void give_way();

  LimbState state() const { return state_; }
  const LimbTarget& target() const { return target_; }
  const GraspConfirmation& confirmation() const { return confirmation_; }
  GraspWitness last_witness() const { return last_witness_; }
  int rung_id() const { return held_rung_id_; }  ///< of the last grasp; below -1: felt only
  bool has_rung() const { return held_rung_id_ != -1; }
  int lost_rung_id() const { return lost_rung_id_; }  ///< that gave way; -1 once another holds
  const LimbGoal& goal() const { return goal_; }
  const std::optional<LimbGoal>& home() const { return home_; }  ///< the old rung
  int num_places() const { return num_places_; }                 ///< tried in this step
  bool moves() const { return moves_; }                          ///< between begin() and LOADED
  bool returned() const { return returned_; }
  bool failed() const { return failed_; }  ///< no grasp, not even on the old rung
  void close_jaw() { is_jaw_forced_ = true; }

 private:
  enum class Stage : std::uint8_t { kSlowing, kOut, kPast, kOver };  ///< of a way in parts

  bool take(LimbEvent event);
  void enter(LimbState from);
  void work(const LimbInput& input);
  bool has_lost(const LimbInput& input) const;
  void work_release(const LimbInput& input, bool arrived);
  void work_transit(bool arrived);
  void work_pregrasp(const LimbInput& input, bool arrived);
  void work_regrasp(const LimbInput& input);
  void finish_closing(const LimbInput& input);
  void pull(const LimbInput& input, bool arrived);
  double pull_slip_m(const LimbInput& input) const;  ///< of the foot, back from the ladder
  void finish_pull(const LimbInput& input);
  bool comes_from_above(const Eigen::Vector3d& foot_m) const;
  void go_past();
  void return_home(const LimbInput& input, bool arrived);
  void keep_budget();
  void forget_tries();
  void remember_home();
  void stay_home();
  void stand_free();
  bool waits_too_long(const LimbInput& input);
  bool must_stay_closed(const LimbInput& input) const;

  void move_foot(const Eigen::Vector3d& to_m, double speed_m_s);
  void move_joints(const LegAngles& to_rad, double min_duration_s);
  bool advance(const LimbInput& input);
  void move_jaw(const LimbInput& input);
  bool is_open(const LimbInput& input) const;
  bool is_first_try() const { return num_tries_ == 0 && num_places_ == 1 && !returned_; }
  bool is_over_budget() const { return spent_s_ >= params_.budget_s; }
  double path_part() const;
  double pull_m_s() const { return motion_.pull_test_m * 1.875 / motion_.pull_s; }  ///< peak
  void follow_body();
  Eigen::Vector3d aimed_m(const Eigen::Vector3d& point_m) const;
  double try_offset_m() const;
  void feel_bump(const LimbInput& input);
  void stand_at(const LegAngles& angles_rad);
  void yield(const LimbInput& input);
  void load(const LimbInput& input, bool arrived);
  Eigen::Vector3d rung_force_N(const LimbInput& input) const;
  ExpectedRung expected_rung(const LimbInput& input) const;

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
  std::optional<LimbGoal> home_;
  std::optional<FootLine> line_;  ///< the path, if straight; else segment_
  JointSegment segment_;
  PathClock clock_;
  double jaw_goal_rad_ = 0.0;
  double in_state_s_ = 0.0;
  double waited_s_ = 0.0;  ///< for the jaw or the others, in this state
  double spent_s_ = 0.0;   ///< since it was lifted, came to its rung, or turned back
  int num_tries_ = 0;      ///< at this place
  int num_places_ = 1;     ///< in this step
  Stage stage_ = Stage::kOver;
  std::optional<Eigen::Vector3d> way_out_m_;   ///< where the approach began, while it is at a rung
  std::optional<Eigen::Vector3d> way_past_m_;  ///< clear of the rung that is passed
  int held_rung_id_ = -1;
  int lost_rung_id_ = -1;
  bool moves_ = false;
  bool parks_ = false;
  bool wants_goal_ = false;
  bool returned_ = false;
  bool failed_ = false;
  bool is_jaw_forced_ = false;
  bool needs_proof_ = false;  ///< felt, not yet pulled at
  bool is_guess_ = false;     ///< ... and its switch has not yet said so
  bool proves_ = false;       ///< is being pulled at
  bool is_doubtful_ = false;
  GraspWitness last_witness_;
  LegAngles unpulled_rad_ = LegAngles::Zero();                     ///< measured before the pull
  Eigen::Isometry3d T_odom_body_ = Eigen::Isometry3d::Identity();  ///< that the points belong to
  Eigen::Vector3d pulled_from_m_ = Eigen::Vector3d::Zero();        ///< odom
  LegAngles torques_before_Nm_ = LegAngles::Zero();
};

}  // namespace climb
