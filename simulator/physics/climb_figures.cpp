// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/physics/climb_figures.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace simulator {

std::string json_members(const Figures& f) {
  char text[400];
  std::snprintf(
      text, sizeof text,
      "\"rungs_climbed\": %d, \"falls\": %d, \"grasps_tried\": %d, \"grasps_failed\": %d, "
      "\"unsafe_grasps\": %d, \"min_support\": %d, \"seconds\": %.1f, "
      "\"peak_joint_torque_Nm\": %.1f, \"peak_grip_N\": %.0f, \"pose_drift_mm\": %.1f",
      f.rungs_climbed, f.falls, f.grasps_tried, f.grasps_failed, f.num_unsafe_grasps, f.min_support,
      f.seconds, f.peak_joint_torque_Nm, f.peak_grip_N, f.pose_drift_mm);
  return text;
}

void ClimbFigures::see(const ClimbMoment& moment) {
  const PlantTruth& truth = moment.truth;
  if (moment.climbs && last_us_ >= 0) {
    figures_.seconds += 1e-6 * static_cast<double>(moment.now_us - last_us_);
  }
  last_us_ = moment.now_us;
  for (int axis = 0; axis < kNumAxes; ++axis) {
    if (is_jaw(axis)) continue;
    figures_.peak_joint_torque_Nm = std::max(
        figures_.peak_joint_torque_Nm, std::fabs(truth.joint_Nm[static_cast<std::size_t>(axis)]));
  }
  int num_holding = 0;
  for (const LegTruth& leg : truth.legs) {
    num_holding += leg.holds ? 1 : 0;
    figures_.peak_grip_N = std::max(figures_.peak_grip_N, leg.force_on_rung_N.norm());
  }
  if (truth.fallen) figures_.falls = 1;
  count_tries(moment);
  if (truth.docked) return;
  has_hung_ = has_hung_ || num_holding == kNumLegs;
  if (!has_hung_) return;
  figures_.min_support = std::min(figures_.min_support, num_holding);
  count_rungs(moment);
  measure_drift(moment);
}

void ClimbFigures::count_tries(const ClimbMoment& moment) {
  for (std::size_t leg = 0; leg < kNumLegs; ++leg) {
    const LimbPhase now = moment.limbs[leg];
    if (now == LimbPhase::kTries && before_[leg] != LimbPhase::kTries) {
      ++figures_.grasps_tried;
      is_unsafe_try_[leg] = false;
    }
    if (now == LimbPhase::kAway && before_[leg] == LimbPhase::kTries) ++figures_.grasps_failed;
    const int rung = moment.truth.legs[leg].rung_index;
    const bool is_unsafe =
        now != LimbPhase::kAway &&
        std::find(unsafe_rungs_.begin(), unsafe_rungs_.end(), rung) != unsafe_rungs_.end();
    if (is_unsafe && !is_unsafe_try_[leg]) {
      ++figures_.num_unsafe_grasps;
      is_unsafe_try_[leg] = true;
    }
    before_[leg] = now;
  }
}

void ClimbFigures::count_rungs(const ClimbMoment& moment) {
  int least_up = kNumLegs * 1000;
  for (const std::size_t leg : {0U, 1U}) {
    const int rung = moment.truth.legs[leg].rung_index;
    if (rung < 0 || moment.limbs[leg] != LimbPhase::kHolds) return;
    if (start_rung_[leg] < 0) start_rung_[leg] = rung;
    least_up = std::min(least_up, rung - start_rung_[leg]);
  }
  figures_.rungs_climbed = std::max(figures_.rungs_climbed, least_up);
}

void ClimbFigures::measure_drift(const ClimbMoment& moment) {
  // Odom and world begin somewhere else: what changes between them is the drift.
  const Eigen::Isometry3d& T_world_body = moment.truth.T_world_body;
  if (!T_odom_world_) T_odom_world_ = moment.T_odom_body * T_world_body.inverse();
  const Eigen::Vector3d true_m = *T_odom_world_ * T_world_body.translation();
  const double error_m = (moment.T_odom_body.translation() - true_m).norm();
  figures_.pose_drift_mm = std::max(figures_.pose_drift_mm, 1e3 * error_m);
}

}  // namespace simulator
