// SPDX-License-Identifier: BSD-3-Clause
#include "climb/attitude.h"

#include <algorithm>
#include <cmath>

namespace climb {
namespace {

constexpr double kMinForce_m_s2 = 1.0;  // less shows no direction

}  // namespace

std::string check(const AttitudeParams& p) {
  if (!(p.time_constant_s > 0.0)) return "time_constant_s must be > 0";
  if (!(p.gravity_m_s2 > 0.0)) return "gravity_m_s2 must be > 0";
  if (!(p.trust_m_s2 > 0.0)) return "trust_m_s2 must be > 0";
  if (!(p.max_gap_s > 0.0)) return "max_gap_s must be > 0";
  return "";
}

bool Attitude::add(const ImuSample& sample) {
  const Eigen::Vector3d& force_m_s2 = sample.accelerometer_m_s2;
  if (!force_m_s2.allFinite() || !sample.gyroscope_rad_s.allFinite()) return false;
  const double dt_s = 1e-6 * static_cast<double>(sample.utime_us - utime_us_);
  if (is_known_ && dt_s == 0.0) return false;
  utime_us_ = sample.utime_us;
  const double length_m_s2 = force_m_s2.norm();
  const bool is_gap = !(dt_s > 0.0 && dt_s <= params_.max_gap_s);
  if (!is_known_ || is_gap) {
    if (length_m_s2 < kMinForce_m_s2) return false;
    start(force_m_s2 / length_m_s2);
    return true;
  }
  // The body turns by w dt, so what is fixed in space turns back in its frame.
  up_body_ -= dt_s * sample.gyroscope_rad_s.cross(up_body_);
  const double off_m_s2 = std::abs(length_m_s2 - params_.gravity_m_s2);
  const double trust = std::max(0.0, 1.0 - off_m_s2 / params_.trust_m_s2);
  const double gain = std::min(1.0, trust * dt_s / params_.time_constant_s);
  if (length_m_s2 > kMinForce_m_s2) up_body_ += gain * (force_m_s2 / length_m_s2 - up_body_);
  up_body_.normalize();
  q_odom_body_ = first_q_odom_body_ * Eigen::Quaterniond::FromTwoVectors(up_body_, first_up_body_);
  q_odom_body_.normalize();
  return true;
}

void Attitude::start(const Eigen::Vector3d& up_body) {
  is_known_ = true;
  up_body_ = up_body;
  if (!has_heading_) fix_heading();
  q_odom_body_ = first_q_odom_body_ * Eigen::Quaterniond::FromTwoVectors(up_body_, first_up_body_);
  q_odom_body_.normalize();
}

void Attitude::fix_heading() {
  has_heading_ = true;
  first_up_body_ = up_body_;
  // Rows of R_odom_body: odom's axes in the body frame. Lying on its side, the head's direction
  // must do.
  Eigen::Vector3d left = Eigen::Vector3d::UnitY() - up_body_.y() * up_body_;
  if (left.squaredNorm() < 0.01) left = up_body_.cross(Eigen::Vector3d::UnitX());
  left.normalize();
  Eigen::Matrix3d R_odom_body;
  R_odom_body.row(0) = left.cross(up_body_);
  R_odom_body.row(1) = left;
  R_odom_body.row(2) = up_body_;
  first_q_odom_body_ = Eigen::Quaterniond(R_odom_body);
}

}  // namespace climb
