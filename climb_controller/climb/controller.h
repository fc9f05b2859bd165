// SPDX-License-Identifier: BSD-3-Clause
// The climbing controller: one step() per cycle from readings to targets that have passed the gate.
// Pure: time comes in, nothing is allocated after construction. States: controller_state.h; which
// fault does what: failsafe.h; what one limb does: limb_cycle.h; where to: step_planner.h.
#pragma once

#include "climb/body_shift.h"
#include "climb/controller_io.h"
#include "climb/fault_watch.h"
#include "climb/step_planner.h"
#include "climb/way_back.h"

namespace climb {

struct ControllerParams {
  ClimbParams climb;
  LimbParams limb;
  ConfirmationParams confirmation;
  GateParams gate;
  WatchParams watch;
  std::uint64_t session_id = 0;  ///< random per run, not 0: commands must echo it
  bool feed_forward = true;      ///< torque that bears the weight
  bool on_ladder = true;         ///< arming grasps; fewer than three grasps = fall alarm
  /// Brakes or self-locking claws carry it without torque (power_off_hold is not "none"), or it
  /// stands in the dock again: only then it may be disarmed while it hangs.
  bool power_off_holds = false;
  double selftest_s = 0.2;
  double enable_timeout_s = 5.0;
  double dock_timeout_s = 120.0;  ///< for four claws to grasp in the dock
  int max_shifts = 2;             ///< of the body before one step
  int max_withdrawn = 3;          ///< targets of one step, then HOLD
  double put_down_after_s = 0.2;  ///< frozen so long, then the limb in the air is put down
  double torque_ramp_s = 0.5;     ///< of the feed-forward, when the dock lets go or takes over
  double max_sag_m = 0.004;       ///< of the body in the dock, without feed-forward
  double max_borne_part = 0.5;    ///< of the weight on the claws: more, and no dock is there
  double reset_after_s = 0.3;     ///< no reset before everything stands
  double look_again_s = 2.0;      ///< for rungs that are no good just now, and at the top
};

/// "" or the violated relation, naming the field.
std::string check(const ControllerParams& params);

class Controller {
 public:
  /// `params` pass check().
  explicit Controller(const ControllerParams& params);

  void step(const ControllerInput& input, ControllerOutput& output);

  ControllerState state() const { return state_; }
  const LimbCycle& limb(Leg leg) const { return limbs_[leg]; }

 private:
  /// When to go over into HOLD.
  enum class Ending : std::uint8_t { kNone, kAtRest, kNow };

  // controller.cpp: faults, orders, states
  FaultFlags faults_of(const ControllerInput& input);
  void react(const Action& action);
  CommandVerdict take_command(const OperatorCommand& command);
  bool obey(Order order);
  bool obey_climb(bool upwards);
  bool obey_hold();
  bool obey_reset();
  bool obey_disarm();
  bool take(ControllerEvent event);

  // controller_work.cpp: what each state does
  void work(const ControllerInput& input);
  void boot(const ControllerInput& input);
  void work_arming(const ControllerInput& input);
  void work_climbing(const ControllerInput& input);
  std::optional<Leg> next_to_grasp() const;
  void start_following(const ControllerInput& input);
  /// By where the jaws stand: the first targets are the measured ones, so none presses just now.
  PerLeg<Hold> claws_round_rungs() const;
  bool prove_grasps();
  void refuse_if_late();
  bool begin_shift(const PerLeg<LegAngles>& told_rad, const PerLeg<LegAngles>& measured_rad);
  bool looks_again();
  /// Than the one that plan_ is refused: over a rung, from another place. It takes some cycles.
  void look_for_other_way(const ControllerInput& input);
  void forget_other_way() {
    other_way_.reset();
    planner_.forget_way();
  }
  bool has_other_way() const { return other_way_ && other_way_->ready; }
  bool end_step(const ControllerInput& input);
  bool ends_here(const RobotNow& now) const;
  Retry retry_of(Leg leg, const ControllerInput& input) const;
  void search(Leg leg, const ControllerInput& input);
  void watch_target(Leg leg, const ControllerInput& input);
  void move(const ControllerInput& input);
  bool must_stop(Leg leg) const;
  bool is_stance_firm() const;
  /// By the rungs that it came up on; not while arming, that looks anew.
  bool goes_back() const { return !upwards_ && state_ != ControllerState::kArming; }

  // controller_stance.cpp: a stance lost, and the claws opened in the dock
  bool lacks_grasps() const;
  bool may_put_down() const;
  void work_put_down(const ControllerInput& input);
  void work_disarming(const ControllerInput& input);
  bool has_sagged() const;
  /// The claws bear the body: upward forces by the legs' torques. True also when not finite.
  bool are_claws_loaded(const ControllerInput& input) const;

  // controller_output.cpp: what it knows, and what it says
  LimbInput limb_input(const ControllerInput& input, Leg leg) const;
  LadderView ladder_of(const ControllerInput& input) const;
  RobotNow robot_now(const ControllerInput& input) const;
  void update_pose(const ControllerInput& input);
  std::optional<Leg> moving_leg() const;
  bool is_under_way() const { return moving_leg().has_value() || shift_.active(); }
  void send(const ControllerInput& input, ControllerOutput& output);
  void add_torques(const ControllerInput& input, PerAxis<AxisCommand>& wanted);
  void weigh_grips(const ControllerInput& input);
  DriveRequest drive_request(const ControllerInput& input) const;
  void report(ControllerOutput& output) const;

  ControllerParams params_;
  PerAxis<AxisLimits> limits_;
  SafetyGate gate_;
  FaultWatch watch_;
  StepPlanner planner_;
  WayBack way_back_;
  BodyShift shift_;
  Odometry odometry_;
  Support support_;
  LegKinematics kinematics_;
  std::array<LimbCycle, kNumLegs> limbs_;

  ControllerState state_ = ControllerState::kBoot;
  Action action_;
  FaultFlags faults_ = 0;
  Fault reason_ = Fault::kNone;
  std::int64_t last_seq_ = -1;
  double in_state_s_ = 0.0;
  bool hangs_ = false;  ///< it hangs on its claws: four were loaded since arming, or three still
  bool is_new_ = true;  ///< never armed: where the robot is, its claws tell
  bool upwards_ = true;
  Ending ending_ = Ending::kNone;
  int num_shifts_ = 0;          ///< before the step that is next
  int num_withdrawn_ = 0;       ///< targets of that step
  int num_steps_to_rest_ = 0;   ///< since HOLD was ordered
  double looked_s_ = 0.0;       ///< standing, for a rung that could be trusted
  bool was_top_ = false;        ///< ... and seen to be at the top all that time
  bool stepping_ = false;       ///< a limb of the crawl is on its way
  bool withdrawn_ = false;      ///< its target is gone
  bool is_vain_ = false;        ///< ... or does not hold
  bool may_step_over_ = false;  ///< what is no rung to grasp, after looking at it for a while
  bool steps_over_ = false;     ///< ... that was long enough
  bool following_ = false;      ///< targets are sent
  bool began_now_ = false;      ///< to follow, in this cycle: the first targets are as measured
  bool rests_safely_ = false;
  Eigen::Isometry3d T_odom_body_before_ = Eigen::Isometry3d::Identity();  ///< lifting or opening
  std::optional<Leg> putting_down_;  ///< in FAULT_HOLD, after a stance was lost
  bool put_down_vain_ = false;       ///< nowhere to put it
  bool parking_ = false;             ///< the claws are opened in the dock
  std::optional<Leg> parked_;        ///< the claw opened last
  bool is_stuck_ = false;            ///< ... and it did not open
  bool at_dock_ = false;
  double torque_part_ = 0.0;  ///< of the feed-forward
  PerLeg<double> grip_N_{};
  bool unsafe_ = false;  ///< the gate refused our own command
  Eigen::Quaterniond q_odom_body_ = Eigen::Quaterniond::Identity();  ///< last sound one
  PlannedStep plan_;
  std::optional<PlannedStep> other_way_;  ///< as last looked for, in this stance
  GateVerdict verdict_;
};

}  // namespace climb
