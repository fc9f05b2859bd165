// SPDX-License-Identifier: BSD-3-Clause
// Every constant of the climbing robot and of its motion, with its source: "run" = measured on the
// simulated robot (physics of claws and servos), "own" = chosen here.
#pragma once

#include <array>
#include <string>

#include "climb/leg.h"

namespace climb {

/// Limits of one joint. The knee's are bends: the sign per leg is RobotParams::knee_sign.
struct JointLimits {
  double min_rad = 0.0;
  double max_rad = 0.0;
  double max_velocity_rad_s = 2.5;        ///< (run)
  double max_acceleration_rad_s2 = 10.0;  ///< (own)
  double max_torque_Nm = 20.0;            ///< continuous, limit of the support check (own)
  double peak_torque_Nm = 30.0;           ///< (own)
};

/// One claw: a fixed finger above the rung, a moving jaw from beneath.
struct ClawParams {
  double width_m = 0.034;       ///< along the rung (run)
  double open_rad = 1.2;        ///< (run)
  double closed_rad = -0.60;    ///< closing target; the jaw's stop, reached only when empty (run)
  double empty_rad = -0.57;     ///< a jaw closed further has missed: thinner than 23 mm (run)
  double on_rung_rad = -0.447;  ///< jaw angle on a rung of this radius (run)
  double on_rung_radius_m = 0.0135;  ///< (run)
  double jaw_rad_per_m = 60.0;       ///< ... and per radius more (run: within 0.02 rad, 24..40 mm)
  double jaw_row_m = 0.012;  ///< fingers stand so far beside the middle: a rung aslant is thicker
  /// A grasp reads what the rung's radius asks for within this (run: pulled at with 100 N it opens
  /// by up to 0.1 rad; a radius told 1.5 mm wrong is 0.09).
  double on_rung_window_rad = 0.16;
  double capture_m = 0.015;           ///< a rung axis nearer to the foot than this is caught (run)
  double seat_up_m = 0.006;           ///< where a settled rung's axis lies, above the foot's point
  double seat_out_m = 0.003;          ///< ... and further in: finger and palm touch it (run: 27 mm)
  double min_rung_radius_m = 0.0115;  ///< on thinner ones the jaw looks empty (run)
  double max_rung_radius_m = 0.021;   ///< (run: 40 mm rungs, and 1 mm)
  double holding_torque_Nm = 3.2;     ///< of the jaw on a rung (run)
  double min_closing_torque_Nm = 0.5;  ///< below: the jaw touches nothing (run)
  double max_torque_Nm = 6.0;          ///< of the jaw's drive (run)
  double max_velocity_rad_s = 6.0;     ///< of the jaw (own)
};

/// Masses [kg]; together 8 kg.
struct MassParams {
  double torso_kg = 4.4;
  double abduction_kg = 0.25;  ///< per leg, between hip and thigh
  double thigh_kg = 0.35;
  double shank_kg = 0.20;
  double claw_kg = 0.10;
};

struct RobotParams {
  double hip_x_m = 0.25;       ///< abduction axis from the body's origin (run)
  double hip_y_m = 0.10;       ///< (run)
  double abduction_m = 0.05;   ///< l1, from the abduction axis sideways to the hip (run)
  double thigh_m = 0.22;       ///< l2 (run)
  double shank_m = 0.24;       ///< l3, knee to foot = centre of a held rung (run)
  double wrist_rad = 0.67;     ///< claw on the shank, fixed; sign per lengthwise_sign (run)
  double min_height_m = 0.02;  ///< a foot is at least so far on the ladder's side of the hip (own)
  /// Front knees bend up and out (q3 > 0), rear knees down and out (run).
  PerLeg<double> knee_sign = {1.0, 1.0, -1.0, -1.0};
  JointLimits abduction{-0.9, 0.9};
  JointLimits hip{-2.6, 2.6};
  JointLimits knee_bend{0.15, 2.7};  ///< of knee_sign * q3
  MassParams mass;
  ClawParams claw;
};

/// Lengths, speeds and times of one limb's step.
struct MotionParams {
  double period_s = 0.01;         ///< control cycle
  double stand_off_m = 0.28;      ///< body origin to the ladder's plane (run: 0.26-0.32 works)
  double lateral_home_m = 0.15;   ///< |y| of a foot (run)
  double retract_m = 0.06;        ///< along the claw's opening axis (run)
  double retract_m_s = 0.20;      ///< (run)
  double clear_m = 0.08;          ///< ... and so much farther where a rung is passed (run)
  double transit_m_s = 0.40;      ///< (run: 0.45 needs 2.26 rad/s)
  double pregrasp_m = 0.05;       ///< before the rung, along the claw's opening axis (run)
  double aim_up_m = 0.008;        ///< the claw comes so much too high: a finger is above (run)
  double aim_out_m = 0.003;       ///< ... and stays so far before the rung (run)
  double approach_m_s = 0.05;     ///< peak, towards the rung (run)
  double bump_N = 30.0;           ///< of a claw on its way: it has met something (run)
  double bump_near_m = 0.015;     ///< met so near its end, it is at its rung (own: capture)
  double cartesian_m_s2 = 1.0;    ///< of the foot on a straight line (own)
  double pull_test_m = 0.010;     ///< back from the ladder (run)
  double pull_further_m = 0.004;  ///< where it falls short of the force: a stretched leg (own)
  double prove_further_m =
      0.026;  ///< ... one found loaded: its push on the ladder goes first (run)
  double pull_test_max_slip_m = 0.007;  ///< a stretched stance gives way by 5.3 mm (run)
  double pull_test_min_N = 40.0;        ///< the static share of a limb (run)
  double pull_test_max_N = 100.0;       ///< (run)
  double seat_m = 0.012;                ///< down at most, until the finger lies on the rung (run)
  double seat_m_s = 0.05;               ///< peak (own)
  double seat_N = 20.0;                 ///< it lies there (own: a limb's static share)
  double unload_s = 0.3;                ///< (run, as are all times)
  double open_s = 0.2;
  double settle_s = 0.1;
  double close_s = 0.35;
  double pull_s = 0.3;
  double load_s = 0.5;
  double body_shift_s = 0.8;
};

struct SupportParams {
  double gravity_m_s2 = 9.81;
  double grip_alarm_N = 150.0;  ///< across the rung: raises the alarm (run: 186 N tears off)
  double friction = 0.5;        ///< of a claw along the rung (run: 0.8; held down to 0.2)
  double squeeze_N = 70.0;      ///< of the jaw at holding torque (own: 3.2 Nm over 45 mm)
  double min_margin = 1.3;      ///< limit / load for a limb to be lifted
  double max_moment_residual_Nm = 0.5;  ///< of weight: above, the contacts do not balance it (own)
  double max_force_residual_N = 0.5;    ///< (own)
  double moment_arm_m = 0.25;           ///< weighs moments against forces (own: half a body)
  int max_iterations = 400;             ///< of the bounded distribution (own)
};

struct OdometryParams {
  double foot_sigma_m = 0.001;          ///< of one foot by FK: drive resolution, bending (own)
  double anchor_sigma_m = 0.002;        ///< of a new hold: the claw settles on its rung (own)
  double slip_m = 0.008;                ///< a foot disagreeing more has slipped (own)
  double orientation_sigma_rad = 0.01;  ///< of the IMU (own)
  double free_drift_m_s = 0.5;          ///< error growth while no foot holds (own)
  /// A new claw slides up to 6 mm down its rung until it has borne two steps of other limbs (run).
  int settled_after = 2;
  double settling_trust = 0.05;  ///< of such a foot, beside 1 (own)
  double settling_s = 0.3;       ///< it takes its place from the others, so slowly (own)
};

/// What makes a point on a rung a grasp for a leg.
struct GraspChoiceParams {
  double max_age_s = 0.30;            ///< of the rungs
  double min_confidence = 0.25;       ///< 3 of 12 frames
  double max_sigma_m = 0.008;         ///< across the rung, at commit (run)
  double claw_margin_m = 0.003;       ///< of a stretch on either side of the claw (own: 40 mm fit)
  double max_lateral_m = 0.06;        ///< from the leg's lateral home (own)
  double min_step_m = 0.15;           ///< a next rung is at least so far along the ladder (own)
  double max_step_m = 0.45;           ///< ... and at most (own)
  double max_long_step_m = 0.70;      ///< over a rung that is missing, or none to grasp (own)
  double min_joint_margin_rad = 0.1;  ///< from every joint limit
  double min_sigma_J_m = 0.03;        ///< least singular value of the Jacobian [m/rad] (own)
  double same_rung_m = 0.07;          ///< a foot so near a rung is on it (own: half a least step)
  double claw_clearance_m = 0.06;     ///< between two claws on one rung, middle to middle (own)
  double retry_distance_m = 0.035;    ///< to a place that was tried in vain (own: a claw's width)
  int num_approach_points = 6;        ///< checked between pregrasp and grasp (own)
  // Cost of a candidate [m]: the smallest wins, ties go to the lower rung id.
  double lateral_cost = 1.0;        ///< per metre from the lateral home (own)
  double step_cost = 1.0;           ///< per metre along the ladder beyond min_step_m (own)
  double sigma_cost = 5.0;          ///< per metre of position error (own)
  double confidence_cost_m = 0.02;  ///< at confidence 0 (own)
  double margin_cost_m = 0.02;      ///< at joint margin 0, falling to 0 at 0.5 rad (own)
};

struct ClimbParams {
  RobotParams robot;
  MotionParams motion;
  SupportParams support;
  OdometryParams odometry;
  GraspChoiceParams grasp;
};

/// "" or the violated relation, naming the field.
std::string check(const ClimbParams& params);

}  // namespace climb
