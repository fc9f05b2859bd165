// SPDX-License-Identifier: BSD-3-Clause
// A kinematic robot on a ladder for controller tests: drives with a first-order lag, jaws that stop
// at a rung, held feet pinned to their rungs, the body where the held feet put it. No dynamics, no
// weight, no compliance beyond a stiffness that turns position errors into torque.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "climb/controller.h"

namespace climb_tests {

class LadderStand {
 public:
  static constexpr double kMoves = std::numeric_limits<double>::quiet_NaN();
  static constexpr double kSpacing_m = 0.30;
  static constexpr double kLag = 0.25;  ///< of the error per cycle: 35 ms

  explicit LadderStand(const climb::ClimbParams& params, int num_rungs = 9)
      : params_(params), kinematics_(params.robot) {
    T_odom_body_.linear() << 0, 0, -1, 0, 1, 0, 1, 0, 0;
    T_odom_body_.translation().setZero();
    for (int k = 1; k <= num_rungs; ++k) add_rung(k);
    for (const climb::Leg leg : climb::kLegs) {
      const Eigen::Vector3d foot_m(0.3 * climb::lengthwise_sign(leg),
                                   0.15 * climb::lateral_sign(leg), -0.22);
      drive_rad_[leg] = measured_rad_[leg] = kinematics_.inverse(leg, foot_m).angles_rad;
      jaw_rad_[leg] = params.robot.claw.open_rad;
    }
    input.now_us = 1'000'000;
    input.estop_clear = true;
    input.drives_ready = true;
    input.imu.valid = true;
    input.imu.q_odom_body = Eigen::Quaterniond(T_odom_body_.linear());
    read();
  }

  /// One cycle: what was sent is followed, then everything is measured again.
  void step(const climb::ControllerOutput& output) {
    using climb::DriveRequest;
    if (output.drives == DriveRequest::kEnable) input.drives_enabled = true;
    const bool ends = output.drives == DriveRequest::kDisable ||
                      output.drives == DriveRequest::kQuickStop ||
                      output.drives == DriveRequest::kHold;
    if (ends) input.drives_enabled = false;
    if (output.send && input.drives_enabled) follow(output.axes);
    input.now_us += 10'000;
    input.command = {};
    read();
  }

  void break_rung(int id) { broken_.push_back(id); }
  /// A claw loses its rung, which is still there for the others.
  void drop(climb::Leg leg) {
    hidden_[leg] = held_rung_[leg];
    held_rung_[leg] = 0;
  }
  void mend_rungs() {
    broken_.clear();
    hidden_ = {};
  }
  /// Odom begins where the body is now.
  void begin_odom_here() {
    const Eigen::Vector3d here_m = T_odom_body_.translation();
    T_odom_body_.translation().setZero();
    for (climb::RungView& rung : rungs) {
      rung.end0_m -= here_m;
      rung.end1_m -= here_m;
    }
    for (Eigen::Vector3d& held_m : held_m_) held_m -= here_m;
    read();
  }
  /// One more rung, numbered on; heights count in rung distances from where rung 0 would be.
  void add_rung_at(double place) {
    add_rung(static_cast<int>(rungs.size()) + 1, place);
    read();
  }
  /// For one leg only the rung is not there.
  void hide_rung(int id, climb::Leg leg) { hidden_[leg] = id; }
  Eigen::Quaterniond upright() const { return Eigen::Quaterniond(T_odom_body_.linear()); }
  const climb::LegAngles& measured_rad(climb::Leg leg) const { return measured_rad_[leg]; }
  bool held(climb::Leg leg) const { return held_rung_[leg] > 0; }
  int held_rung(climb::Leg leg) const { return held_rung_[leg]; }  ///< 0 = none
  double body_height_m() const { return T_odom_body_.translation().z(); }

  climb::ControllerInput input;
  double stiffness_Nm_rad = 800.0;                              ///< of each joint
  climb::PerLeg<double> stiffness_part = {1.0, 1.0, 1.0, 1.0};  ///< of a rung that gives way: less
  bool sags = false;  ///< without feed-forward, as when no dock is there
  /// A jaw that moves no more, not even with its rung; NaN = it moves.
  climb::PerLeg<double> stuck_jaw_rad = {kMoves, kMoves, kMoves, kMoves};
  bool sees = true;
  double sees_up_m = 10.0;  ///< above the body; what is higher is not in the message
  std::vector<climb::RungView> rungs;
  std::vector<climb::StretchView> stretches;

 private:
  void add_rung(int k) { add_rung(k, k); }
  void add_rung(int k, double place) {
    climb::RungView rung;
    rung.id = k;
    rung.trusted = true;
    rung.confidence = 1.0;
    const double z_m = kSpacing_m * (place - 2);
    rung.end0_m = Eigen::Vector3d(params_.motion.stand_off_m, 0.2, z_m);
    rung.end1_m = Eigen::Vector3d(params_.motion.stand_off_m, -0.2, z_m);
    rung.radius_m = 0.014;
    rung.covariance_m2 = 1e-6 * Eigen::Matrix3d::Identity();
    rungs.push_back(rung);
    stretches.push_back({static_cast<int>(rungs.size()) - 1, 0.02, 0.38});
  }

  bool is_broken(int id) const {
    return std::find(broken_.begin(), broken_.end(), id) != broken_.end();
  }

  int rung_at(climb::Leg leg) const {
    const Eigen::Vector3d foot_m = T_odom_body_ * kinematics_.foot_m(leg, measured_rad_[leg]);
    for (const climb::RungView& rung : rungs) {
      const double off_m =
          std::max(std::abs(foot_m.z() - rung.end0_m.z()), std::abs(foot_m.x() - rung.end0_m.x()));
      if (off_m < params_.robot.claw.capture_m && !is_broken(rung.id) && hidden_[leg] != rung.id)
        return rung.id;
    }
    return 0;
  }

  /// The closing jaw draws the claw to its seat.
  void center(Eigen::Vector3d& held_m, int id) const {
    for (const climb::RungView& rung : rungs) {
      if (rung.id != id) continue;
      held_m.x() = rung.end0_m.x();
      held_m.z() = rung.end0_m.z();
    }
  }

  void follow(const climb::PerAxis<climb::AxisCommand>& axes) {
    const climb::ClawParams& claw = params_.robot.claw;
    int num_held = 0;
    Eigen::Vector3d place_m = Eigen::Vector3d::Zero();
    for (const climb::Leg leg : climb::kLegs) {
      for (int joint = 0; joint < climb::kNumLegJoints; ++joint) {
        const double wanted_rad = axes[climb::axis_of(leg, joint)].position_rad;
        drive_rad_[leg][joint] += kLag * (wanted_rad - drive_rad_[leg][joint]);
      }
      const double jaw_wanted_rad = axes[climb::axis_of(leg, climb::kJaw)].position_rad;
      const bool is_stuck = std::isfinite(stuck_jaw_rad[leg]);
      const double jaw_goal_rad = is_stuck ? stuck_jaw_rad[leg] : jaw_wanted_rad;
      const int rung = rung_at(leg);
      const bool closes = jaw_goal_rad < claw.on_rung_rad + 1e-9;
      if (is_broken(held_rung_[leg]) || !closes) held_rung_[leg] = 0;
      if (closes && rung > 0 && held_rung_[leg] == 0 && jaw_rad_[leg] > claw.on_rung_rad - 0.02) {
        held_rung_[leg] = rung;
        held_m_[leg] = T_odom_body_ * kinematics_.foot_m(leg, measured_rad_[leg]);
        center(held_m_[leg], rung);
      }
      const double stop_rad = held_rung_[leg] > 0 ? claw.on_rung_rad : claw.closed_rad;
      jaw_rad_[leg] = std::max(jaw_goal_rad, stop_rad);
      jaw_torque_Nm_[leg] = 20.0 * (jaw_wanted_rad - jaw_rad_[leg]);
      if (held_rung_[leg] == 0) continue;
      ++num_held;
      place_m += held_m_[leg] - T_odom_body_.linear() * kinematics_.foot_m(leg, drive_rad_[leg]);
    }
    // The stand holds the body until all four claws hold for the first time.
    hangs_ = hangs_ || num_held == climb::kNumLegs;
    if (hangs_ && num_held >= 2) T_odom_body_.translation() = place_m / num_held;
    double torque_Nm = 0.0;
    for (const climb::AxisCommand& axis : axes) torque_Nm += std::abs(axis.torque_Nm);
    if (hangs_ && sags && torque_Nm < 0.5) T_odom_body_.translation().z() -= 0.008;
  }

  void read() {
    for (const climb::Leg leg : climb::kLegs) {
      measured_rad_[leg] = drive_rad_[leg];
      if (held_rung_[leg] > 0) {
        const Eigen::Vector3d foot_m = T_odom_body_.inverse() * held_m_[leg];
        const climb::LegSolution pinned = kinematics_.inverse(leg, foot_m);
        if (pinned.reachable()) measured_rad_[leg] = pinned.angles_rad;
      }
      for (int joint = 0; joint < climb::kNumLegJoints; ++joint) {
        const double error_rad = drive_rad_[leg][joint] - measured_rad_[leg][joint];
        input.axes[climb::axis_of(leg, joint)] = {
            measured_rad_[leg][joint], stiffness_part[leg] * stiffness_Nm_rad * error_rad, true};
      }
      input.axes[climb::axis_of(leg, climb::kJaw)] = {jaw_rad_[leg], jaw_torque_Nm_[leg], true};
      input.touch[leg] = held_rung_[leg] > 0;
    }
    if (sees) input.ladder_received_us = input.now_us;
    seen_.clear();
    for (const climb::RungView& rung : rungs) {
      if (!(rung.end0_m.z() > body_height_m() + sees_up_m)) seen_.push_back(rung);
    }
    input.ladder = {seen_, std::span(stretches).first(seen_.size()), 0.0, true};
  }

  std::vector<climb::RungView> seen_;
  climb::ClimbParams params_;
  climb::LegKinematics kinematics_;
  Eigen::Isometry3d T_odom_body_ = Eigen::Isometry3d::Identity();
  climb::PerLeg<climb::LegAngles> drive_rad_;
  climb::PerLeg<climb::LegAngles> measured_rad_;
  climb::PerLeg<double> jaw_rad_{};
  climb::PerLeg<double> jaw_torque_Nm_{};
  climb::PerLeg<int> held_rung_{};
  climb::PerLeg<Eigen::Vector3d> held_m_;
  std::vector<int> broken_;
  climb::PerLeg<int> hidden_{};
  bool hangs_ = false;
};

}  // namespace climb_tests
