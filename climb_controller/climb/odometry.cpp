// SPDX-License-Identifier: BSD-3-Clause
#include "climb/odometry.h"

#include <cmath>

namespace climb {
namespace {

constexpr double kLeastWeight = 1e-3;
constexpr double kMaxUnitError = 1e-3;  ///< of a quaternion's norm

bool valid(const OdometryInput& input) {
  if (!(std::abs(input.q_odom_body.norm() - 1.0) <= kMaxUnitError)) return false;
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
  if (fixed_) locate(input);
  fixed_ = true;
  keep_anchors(input);
  return estimate_;
}

void Odometry::locate(const OdometryInput& input) {
  Eigen::Vector3d sum_m = Eigen::Vector3d::Zero();
  double sum_variance_m2 = 0.0;
  double sum_weight = 0.0;
  double sum_weight2 = 0.0;
  estimate_.num_feet = 0;
  for (const Leg leg : kLegs) {
    const double weight = input.weight[leg];
    if (!(weight > kLeastWeight) || !anchors_[leg].set) continue;
    const Eigen::Vector3d foot_m = kinematics_.foot_m(leg, input.angles_rad[leg]);
    sum_m += weight * (anchors_[leg].position_m - estimate_.q_odom_body * foot_m);
    sum_variance_m2 += weight * anchors_[leg].variance_m2;
    sum_weight += weight;
    sum_weight2 += weight * weight;
    ++estimate_.num_feet;
  }
  if (estimate_.num_feet == 0) {
    estimate_.position_sigma_m += params_.free_drift_m_s * input.dt_s;
    estimate_.slipped.reset();
    return;
  }
  estimate_.position_odom_m = sum_m / sum_weight;
  // Anchors come from one another and share their errors: those are averaged, not divided.
  const double foot_variance_m2 = params_.foot_sigma_m * params_.foot_sigma_m;
  estimate_.position_sigma_m = std::sqrt(
      sum_variance_m2 / sum_weight + foot_variance_m2 * sum_weight2 / (sum_weight * sum_weight));
  find_slip(input);
}

void Odometry::find_slip(const OdometryInput& input) {
  estimate_.slipped.reset();
  double worst_m = params_.slip_m;
  for (const Leg leg : kLegs) {
    if (!(input.weight[leg] > kLeastWeight) || !anchors_[leg].set) continue;
    const Eigen::Vector3d foot_odom_m =
        estimate_.position_odom_m +
        estimate_.q_odom_body * kinematics_.foot_m(leg, input.angles_rad[leg]);
    const double off_m = (anchors_[leg].position_m - foot_odom_m).norm();
    if (off_m > worst_m) {
      worst_m = off_m;
      estimate_.slipped = leg;
    }
  }
}

void Odometry::keep_anchors(const OdometryInput& input) {
  for (const Leg leg : kLegs) {
    Anchor& anchor = anchors_[leg];
    const bool is_loaded = input.weight[leg] >= 1.0 - kLeastWeight;
    if (!(input.weight[leg] > kLeastWeight)) {
      anchor.set = false;
    } else if (!anchor.set && is_loaded) {  // while it is being loaded its claw still settles
      anchor.set = true;
      anchor.position_m = estimate_.position_odom_m +
                          estimate_.q_odom_body * kinematics_.foot_m(leg, input.angles_rad[leg]);
      anchor.variance_m2 = estimate_.position_sigma_m * estimate_.position_sigma_m +
                           params_.anchor_sigma_m * params_.anchor_sigma_m;
    }
  }
}

std::optional<Eigen::Vector3d> Odometry::anchor_m(Leg leg) const {
  if (!anchors_[leg].set) return std::nullopt;
  return anchors_[leg].position_m;
}

}  // namespace climb
