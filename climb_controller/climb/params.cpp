// SPDX-License-Identifier: BSD-3-Clause
#include "climb/params.h"

#include <span>

#include "base/within.h"

namespace climb {
namespace {

struct Relation {
  bool holds;
  const char* words;
};

constexpr double kLeastClosing_rad = 0.02;  ///< between an empty jaw's stop and what counts as full

double widest_rad(const ClawParams& p) {
  return p.on_rung_rad + p.jaw_rad_per_m * (p.max_rung_radius_m - p.on_rung_radius_m) +
         p.on_rung_window_rad;
}

std::string first_violated(std::span<const Relation> relations, const char* where) {
  for (const Relation& relation : relations) {
    if (!relation.holds) return std::string(where) + "." + relation.words;
  }
  return "";
}

std::string check(const JointLimits& p, const char* where) {
  const Relation relations[] = {
      {base::within(p.min_rad, -6.3, 6.3), "min_rad must be -6.3..6.3"},
      {base::within(p.max_rad, p.min_rad + 0.01, 6.3), "max_rad must be min_rad + 0.01..6.3"},
      {base::within(p.max_velocity_rad_s, 0.01, 20.0), "max_velocity_rad_s must be 0.01..20"},
      {base::within(p.max_acceleration_rad_s2, 0.1, 1000.0),
       "max_acceleration_rad_s2 must be 0.1..1000"},
      {base::within(p.max_torque_Nm, 0.1, 1000.0), "max_torque_Nm must be 0.1..1000"},
      {base::within(p.peak_torque_Nm, p.max_torque_Nm, 1000.0),
       "peak_torque_Nm must be max_torque_Nm..1000"},
  };
  return first_violated(relations, where);
}

std::string check(const ClawParams& p) {
  const Relation relations[] = {
      {base::within(p.width_m, 0.001, 0.2), "width_m must be 0.001..0.2"},
      {base::within(p.closed_rad, -3.2, 3.2), "closed_rad must be -3.2..3.2"},
      {base::within(p.on_rung_rad, p.closed_rad, 3.2), "on_rung_rad must be closed_rad..3.2"},
      {base::within(p.empty_rad, p.closed_rad + kLeastClosing_rad, p.on_rung_rad),
       "empty_rad must be closed_rad + 0.02..on_rung_rad: an empty claw must not look full"},
      {base::within(p.on_rung_radius_m, p.min_rung_radius_m, p.max_rung_radius_m),
       "on_rung_radius_m must be min_rung_radius_m..max_rung_radius_m"},
      {base::within(p.jaw_rad_per_m, 0.0, 1000.0), "jaw_rad_per_m must be 0..1000"},
      {base::within(p.jaw_row_m, 0.0, 0.5 * p.width_m), "jaw_row_m must be 0..half of width_m"},
      {base::within(p.on_rung_window_rad, 0.0, 1.0), "on_rung_window_rad must be 0..1"},
      {base::within(p.open_rad, widest_rad(p), 3.2),
       "open_rad must be beyond what the thickest rung asks for..3.2"},
      {base::within(p.capture_m, 0.001, 0.1), "capture_m must be 0.001..0.1"},
      {base::within(p.seat_up_m, -0.05, 0.05), "seat_up_m must be -0.05..0.05"},
      {base::within(p.seat_out_m, -0.05, 0.05), "seat_out_m must be -0.05..0.05"},
      {base::within(p.min_rung_radius_m, 0.001, 0.1), "min_rung_radius_m must be 0.001..0.1"},
      {base::within(p.max_rung_radius_m, p.min_rung_radius_m, 0.1),
       "max_rung_radius_m must be min_rung_radius_m..0.1"},
      {base::within(p.min_closing_torque_Nm, 0.0, p.holding_torque_Nm),
       "min_closing_torque_Nm must be 0..holding_torque_Nm"},
      {base::within(p.holding_torque_Nm, 0.0, p.max_torque_Nm),
       "holding_torque_Nm must be 0..max_torque_Nm"},
      {base::within(p.max_torque_Nm, 0.1, 100.0), "max_torque_Nm must be 0.1..100"},
      {base::within(p.max_velocity_rad_s, 0.1, 100.0), "max_velocity_rad_s must be 0.1..100"},
  };
  return first_violated(relations, "robot.claw");
}

std::string check(const RobotParams& p) {
  bool knees_known = true;
  for (const double sign : p.knee_sign) knees_known = knees_known && (sign == 1.0 || sign == -1.0);
  const MassParams& m = p.mass;
  const Relation relations[] = {
      {base::within(p.hip_x_m, 0.0, 2.0), "hip_x_m must be 0..2"},
      {base::within(p.hip_y_m, 0.0, 2.0), "hip_y_m must be 0..2"},
      {base::within(p.abduction_m, 0.001, 1.0), "abduction_m must be 0.001..1"},
      {base::within(p.thigh_m, 0.01, 2.0), "thigh_m must be 0.01..2"},
      {base::within(p.shank_m, 0.01, 2.0), "shank_m must be 0.01..2"},
      {base::within(p.wrist_rad, -1.6, 1.6), "wrist_rad must be -1.6..1.6"},
      {base::within(p.min_height_m, 0.001, p.thigh_m), "min_height_m must be 0.001..thigh_m"},
      {knees_known, "knee_sign must be 1 or -1 for each leg"},
      {base::within(p.knee_bend.min_rad, 0.01, 3.1),
       "knee_bend.min_rad must be 0.01..3.1: a straight leg "
       "is singular"},
      {base::within(p.knee_bend.max_rad, 0.02, 3.1), "knee_bend.max_rad must be 0.02..3.1"},
      {base::within(m.torso_kg, 0.01, 1000.0), "mass.torso_kg must be 0.01..1000"},
      {base::within(m.abduction_kg, 0.0, 100.0), "mass.abduction_kg must be 0..100"},
      {base::within(m.thigh_kg, 0.0, 100.0), "mass.thigh_kg must be 0..100"},
      {base::within(m.shank_kg, 0.0, 100.0), "mass.shank_kg must be 0..100"},
      {base::within(m.claw_kg, 0.0, 100.0), "mass.claw_kg must be 0..100"},
  };
  return first_violated(relations, "robot");
}

std::string check(const MotionParams& p) {
  const Relation relations[] = {
      {base::within(p.period_s, 0.001, 0.1), "period_s must be 0.001..0.1"},
      {base::within(p.stand_off_m, 0.05, 2.0), "stand_off_m must be 0.05..2"},
      {base::within(p.lateral_home_m, 0.0, 2.0), "lateral_home_m must be 0..2"},
      {base::within(p.retract_m, 0.0, 0.5), "retract_m must be 0..0.5"},
      {base::within(p.retract_m_s, 0.001, 2.0), "retract_m_s must be 0.001..2"},
      {base::within(p.transit_m_s, 0.001, 2.0), "transit_m_s must be 0.001..2"},
      {base::within(p.pregrasp_m, 0.0, 0.5), "pregrasp_m must be 0..0.5"},
      {base::within(p.aim_up_m, -0.05, 0.05), "aim_up_m must be -0.05..0.05"},
      {base::within(p.aim_out_m, -0.05, 0.05), "aim_out_m must be -0.05..0.05"},
      {base::within(p.bump_N, 1.0, 1000.0), "bump_N must be 1..1000"},
      {base::within(p.bump_near_m, 0.0, 0.5), "bump_near_m must be 0..0.5"},
      {base::within(p.approach_m_s, 0.001, 0.05), "approach_m_s must be 0.001..0.05"},
      {base::within(p.cartesian_m_s2, 0.01, 100.0), "cartesian_m_s2 must be 0.01..100"},
      {base::within(p.pull_test_m, 0.0, 0.05), "pull_test_m must be 0..0.05"},
      {base::within(p.clear_m, 0.0, 0.15), "clear_m must be 0..0.15"},
      {base::within(p.pull_further_m, 0.0, 0.05), "pull_further_m must be 0..0.05"},
      {base::within(p.prove_further_m, 0.0, 0.05), "prove_further_m must be 0..0.05"},
      {base::within(p.pull_test_max_slip_m, 0.0, 0.05), "pull_test_max_slip_m must be 0..0.05"},
      {base::within(p.pull_test_min_N, 0.0, p.pull_test_max_N),
       "pull_test_min_N must be 0..pull_test_max_N"},
      {base::within(p.seat_m, 0.0, 0.05), "seat_m must be 0..0.05"},
      {base::within(p.seat_m_s, 0.001, 0.2), "seat_m_s must be 0.001..0.2"},
      {base::within(p.seat_N, 0.1, 1000.0), "seat_N must be 0.1..1000"},
      {base::within(p.pull_test_max_N, 0.0, 1000.0), "pull_test_max_N must be 0..1000"},
  };
  const double times_s[] = {p.unload_s, p.open_s, p.settle_s,    p.close_s,
                            p.pull_s,   p.load_s, p.body_shift_s};
  for (const double time_s : times_s) {
    if (!base::within(time_s, 0.01, 10.0)) {
      return "motion: unload_s, open_s, settle_s, close_s, pull_s, load_s and body_shift_s must be "
             "0.01..10";
    }
  }
  return first_violated(relations, "motion");
}

std::string check(const SupportParams& p) {
  const Relation relations[] = {
      {base::within(p.gravity_m_s2, 0.1, 30.0), "gravity_m_s2 must be 0.1..30"},
      {base::within(p.grip_alarm_N, 1.0, 10000.0), "grip_alarm_N must be 1..10000"},
      {base::within(p.friction, 0.01, 2.0), "friction must be 0.01..2"},
      {base::within(p.squeeze_N, 0.1, 10000.0), "squeeze_N must be 0.1..10000"},
      {base::within(p.min_margin, 1.0, 10.0), "min_margin must be 1..10"},
      {base::within(p.max_moment_residual_Nm, 1e-6, 100.0),
       "max_moment_residual_Nm must be 1e-6..100"},
      {base::within(p.max_force_residual_N, 1e-6, 100.0), "max_force_residual_N must be 1e-6..100"},
      {base::within(p.moment_arm_m, 0.01, 10.0), "moment_arm_m must be 0.01..10"},
      {base::within(p.max_iterations, 1, 100000), "max_iterations must be 1..100000"},
  };
  return first_violated(relations, "support");
}

std::string check(const OdometryParams& p) {
  const Relation relations[] = {
      {base::within(p.foot_sigma_m, 1e-6, 1.0), "foot_sigma_m must be 1e-6..1"},
      {base::within(p.anchor_sigma_m, 1e-6, 1.0), "anchor_sigma_m must be 1e-6..1"},
      {base::within(p.slip_m, 1e-6, 1.0), "slip_m must be 1e-6..1"},
      {base::within(p.orientation_sigma_rad, 0.0, 1.0), "orientation_sigma_rad must be 0..1"},
      {base::within(p.free_drift_m_s, 0.0, 10.0), "free_drift_m_s must be 0..10"},
      {base::within(p.settled_after, 0, 3), "settled_after must be 0..3"},
      {base::within(p.settling_trust, 1e-6, 1.0), "settling_trust must be 1e-6..1"},
      {base::within(p.settling_s, 0.01, 100.0), "settling_s must be 0.01..100"},
  };
  return first_violated(relations, "odometry");
}

std::string check(const GraspChoiceParams& p) {
  const Relation relations[] = {
      {base::within(p.max_age_s, 0.01, 10.0), "max_age_s must be 0.01..10"},
      {base::within(p.min_confidence, 0.0, 1.0), "min_confidence must be 0..1"},
      {base::within(p.max_sigma_m, 1e-4, 0.1), "max_sigma_m must be 1e-4..0.1"},
      {base::within(p.claw_margin_m, 0.0, 0.1), "claw_margin_m must be 0..0.1"},
      {base::within(p.max_lateral_m, 0.0, 1.0), "max_lateral_m must be 0..1"},
      {base::within(p.min_step_m, 0.01, 1.0), "min_step_m must be 0.01..1"},
      {base::within(p.max_step_m, p.min_step_m, 2.0), "max_step_m must be min_step_m..2"},
      {base::within(p.max_long_step_m, p.max_step_m, 2.0), "max_long_step_m must be max_step_m..2"},
      {base::within(p.min_joint_margin_rad, 0.0, 1.0), "min_joint_margin_rad must be 0..1"},
      {base::within(p.min_sigma_J_m, 0.0, 1.0), "min_sigma_J_m must be 0..1"},
      {base::within(p.claw_clearance_m, 0.0, 1.0), "claw_clearance_m must be 0..1"},
      {base::within(p.same_rung_m, 0.0, 0.5 * p.min_step_m),
       "same_rung_m must be 0..min_step_m / 2"},
      {base::within(p.retry_distance_m, 0.0, 1.0), "retry_distance_m must be 0..1"},
      {base::within(p.num_approach_points, 0, 1000), "num_approach_points must be 0..1000"},
      {base::within(p.lateral_cost, 0.0, 1e3), "lateral_cost must be 0..1000"},
      {base::within(p.step_cost, 0.0, 1e3), "step_cost must be 0..1000"},
      {base::within(p.sigma_cost, 0.0, 1e3), "sigma_cost must be 0..1000"},
      {base::within(p.confidence_cost_m, 0.0, 1e3), "confidence_cost_m must be 0..1000"},
      {base::within(p.margin_cost_m, 0.0, 1e3), "margin_cost_m must be 0..1000"},
  };
  return first_violated(relations, "grasp");
}

}  // namespace

std::string check(const ClimbParams& params) {
  const std::string violated[] = {check(params.robot),
                                  check(params.robot.abduction, "robot.abduction"),
                                  check(params.robot.hip, "robot.hip"),
                                  check(params.robot.knee_bend, "robot.knee_bend"),
                                  check(params.robot.claw),
                                  check(params.motion),
                                  check(params.support),
                                  check(params.odometry),
                                  check(params.grasp)};
  for (const std::string& words : violated) {
    if (!words.empty()) return words;
  }
  return "";
}

}  // namespace climb
