// SPDX-License-Identifier: BSD-3-Clause
#include "climb/odometry.h"

#include <algorithm>
#include <cmath>

#include "climb/unit.h"

namespace climb {
namespace {

constexpr double kLeastWeight = 1e-3;

bool valid(const OdometryInput& input) {
  if (!is_unit(input.q_odom_body)) return false;
  if (!(input.dt_s >= 0.0 && input.dt_s <= 1e3)) return false;
  for (const Leg leg : kLegs) {
    if (!input.angles_rad[leg].allFinite()) return false;
    if (!(input.weight[leg] >= 0.0 && input.weight[leg] <= 1.0)) return false;
  }
  return true;
}

}  // namespace

Eigen::Isometry3d OdometryEstimate::T_odom_body() const {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = q_odom_body.toRotationMatrix();
  pose.translation() = position_odom_m;
  return pose;
}

Odometry::Odometry(const RobotParams& robot, const OdometryParams& params)
    : kinematics_(robot), params_(params) {
  reset();
}

void Odometry::reset() {
  estimate_ = OdometryEstimate();
  estimate_.orientation_sigma_rad = params_.orientation_sigma_rad;
  anchors_ = {};
  fixed_ = false;
}

const OdometryEstimate& Odometry::update(const OdometryInput& input) {
  if (!valid(input)) {
    if (input.dt_s >= 0.0 && input.dt_s <= 1e3) {
      estimate_.position_sigma_m += params_.free_drift_m_s * input.dt_s;
    }
    return estimate_;
  }
  estimate_.q_odom_body = input.q_odom_body.normalized();
  const bool is_first = !fixed_;
  if (!is_first) locate(input);
  fixed_ = true;
  keep_anchors(input, is_first);
  return estimate_;
}

void Odometry::locate(const OdometryInput& input) {
  Eigen::Vector3d by_all_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d by_settled_m = Eigen::Vector3d::Zero();
  double sum_variance_m2 = 0.0;
  double sum_all = 0.0;
  double sum_weight = 0.0;
  double sum_weight2 = 0.0;
  estimate_.num_feet = 0;
  for (const Leg leg : kLegs) {
    if (!(input.weight[leg] > kLeastWeight) || !anchors_[leg].set) continue;
    const double weight = input.weight[leg] * (has_settled(leg) ? 1.0 : params_.settling_trust);
    const Eigen::Vector3d body_m =
        anchors_[leg].position_m -
        estimate_.q_odom_body * kinematics_.seat_m(leg, input.angles_rad[leg]);
    by_all_m += input.weight[leg] * body_m;
    by_settled_m += weight * body_m;
    sum_variance_m2 += weight * anchors_[leg].variance_m2;
    sum_all += input.weight[leg];
    sum_weight += weight;
    sum_weight2 += weight * weight;
    ++estimate_.num_feet;
  }
  if (estimate_.num_feet == 0) {
    estimate_.position_sigma_m += params_.free_drift_m_s * input.dt_s;
    estimate_.slipped.reset();
    return;
  }
  // A claw settles along the ladder, by its load: there the settled ones count. In other directions
  // all count alike: one foot alone would add what an unseen turn of the body moves it.
  const Eigen::Vector3d up = estimate_.q_odom_body * Eigen::Vector3d::UnitX();
  by_all_m /= sum_all;
  by_settled_m /= sum_weight;
  estimate_.position_odom_m = by_all_m + up.dot(by_settled_m - by_all_m) * up;
  // Anchors come from one another and share their errors: those are averaged, not divided.
  const double foot_variance_m2 = params_.foot_sigma_m * params_.foot_sigma_m;
  estimate_.position_sigma_m = std::sqrt(
      sum_variance_m2 / sum_weight + foot_variance_m2 * sum_weight2 / (sum_weight * sum_weight));
  find_slip(input);
}

Eigen::Vector3d Odometry::seat_odom_m(const OdometryInput& input, Leg leg) const {
  return estimate_.position_odom_m +
         estimate_.q_odom_body * kinematics_.seat_m(leg, input.angles_rad[leg]);
}

void Odometry::find_slip(const OdometryInput& input) {
  estimate_.slipped.reset();
  double worst_m = params_.slip_m;
  for (const Leg leg : kLegs) {
    if (!(input.weight[leg] > kLeastWeight) || !anchors_[leg].set) continue;
    const double off_m = (anchors_[leg].position_m - seat_odom_m(input, leg)).norm();
    if (off_m > worst_m) {
      worst_m = off_m;
      estimate_.slipped = leg;
    }
  }
}

void Odometry::keep_anchors(const OdometryInput& input, bool is_first) {
  const double part = std::min(1.0, input.dt_s / params_.settling_s);
  const Eigen::Vector3d up = estimate_.q_odom_body * Eigen::Vector3d::UnitX();
  for (const Leg leg : kLegs) {
    Anchor& anchor = anchors_[leg];
    const bool is_loaded = input.weight[leg] >= 1.0 - kLeastWeight;
    if (!(input.weight[leg] > kLeastWeight)) {
      anchor.set = false;
    } else if (!anchor.set && is_loaded) {  // while it is being loaded its claw still settles
      set_anchor(leg, seat_odom_m(input, leg), is_first);
    } else if (anchor.set && !has_settled(leg)) {
      const Eigen::Vector3d off_m = seat_odom_m(input, leg) - anchor.position_m;
      anchor.position_m += part * up.dot(off_m) * up;
    }
  }
}

void Odometry::set_anchor(Leg leg, const Eigen::Vector3d& seat_odom_m, bool is_first) {
  for (Anchor& other : anchors_) ++other.num_later;
  Anchor& anchor = anchors_[leg];
  anchor.set = true;
  anchor.num_later = is_first ? params_.settled_after : 0;  // the first hold together, for the best
  anchor.position_m = seat_odom_m;
  anchor.variance_m2 = estimate_.position_sigma_m * estimate_.position_sigma_m +
                       params_.anchor_sigma_m * params_.anchor_sigma_m;
}

std::optional<Eigen::Vector3d> Odometry::anchor_m(Leg leg) const {
  if (!anchors_[leg].set) return std::nullopt;
  return anchors_[leg].position_m;
}

}  // namespace climb
