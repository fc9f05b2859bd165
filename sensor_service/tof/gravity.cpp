// SPDX-License-Identifier: BSD-3-Clause
#include "tof/gravity.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"

namespace tof {
namespace {

constexpr double kMaxTurnRate_rad_s = 1e3;
constexpr double kMinSineOfView = 0.1;  ///< below it a view counts as vertical (5.7 deg)
constexpr double kMinForce_m_s2 = 1.0;  ///< a shorter mean force points nowhere

bool are_within(const Eigen::Vector3d& v, double limit) {
  return std::abs(v.x()) <= limit && std::abs(v.y()) <= limit && std::abs(v.z()) <= limit;
}

/// v as the body sees it after turning by angle_rad (Cayley's map: a rotation for any angle, exact
/// to third order, without trigonometry).
Eigen::Vector3d turned_back(const Eigen::Vector3d& v, const Eigen::Vector3d& angle_rad) {
  const Eigen::Vector3d half = 0.5 * angle_rad;
  const double length = std::sqrt(1.0 + half.squaredNorm());
  const double w = 1.0 / length;
  const Eigen::Vector3d u = -half / length;
  const Eigen::Vector3d t = 2.0 * u.cross(v);
  return v + w * t + u.cross(t);
}

}  // namespace

Gravity::Gravity(const GravityParams& params, const PoseParams& history)
    : params_(params), up_(history) {}

double Gravity::weight_of(const Eigen::Vector3d& accelerometer_m_s2) const {
  const double excess_m_s2 =
      std::abs(std::sqrt(accelerometer_m_s2.squaredNorm()) - params_.gravity_m_s2);
  return std::max(0.0, 1.0 - excess_m_s2 / params_.trust_m_s2);
}

bool Gravity::add(const ImuSample& sample) {
  // Written so that NaN fails.
  if (!are_within(sample.accelerometer_m_s2, 1e3)) return false;
  if (!are_within(sample.gyroscope_rad_s, kMaxTurnRate_rad_s)) return false;
  if (sample.accelerometer_m_s2.squaredNorm() < 1e-12) return false;  // a unit that is not running
  if (utime_us_ != 0 && sample.utime_us <= utime_us_) return false;

  const double weight = weight_of(sample.accelerometer_m_s2);
  const double step_s = static_cast<double>(sample.utime_us - utime_us_) * 1e-6;
  if (weight_sum_ == 0.0 || step_s > params_.max_gap_s) {
    if (weight == 0.0) return false;  // the first sample must show gravity
    force_m_s2_ = sample.accelerometer_m_s2;
    weight_sum_ = weight;
  } else {
    force_m_s2_ = turned_back(force_m_s2_, step_s * sample.gyroscope_rad_s);
    weight_sum_ += weight;
    const double gain =
        std::max(weight / weight_sum_, weight * step_s / (params_.time_constant_s + step_s));
    force_m_s2_ += gain * (sample.accelerometer_m_s2 - force_m_s2_);
  }
  utime_us_ = sample.utime_us;

  const double length = std::sqrt(force_m_s2_.squaredNorm());
  if (length >= kMinForce_m_s2) up_.push(sample.utime_us, force_m_s2_ / length);
  return true;
}

std::optional<Eigen::Vector3d> Gravity::up_at(std::int64_t utime_us) const {
  const auto bracket = up_.at(utime_us);
  if (!bracket) return std::nullopt;
  return interpolate(*bracket->a, *bracket->b, bracket->fraction);
}

std::optional<Eigen::Vector3d> Gravity::newest_up() const {
  if (up_.size() == 0) return std::nullopt;
  return up_.newest_value();
}

void Gravity::clear() {
  utime_us_ = 0;
  weight_sum_ = 0.0;
  up_.clear();
}

void GravityFrame::fix(const Eigen::Vector3d& up_body, const Eigen::Vector3d& view_body,
                       const Eigen::Vector3d& image_up_body) {
  const double rise = view_body.dot(up_body);
  Eigen::Vector3d ahead = view_body - rise * up_body;
  if (ahead.squaredNorm() < kMinSineOfView * kMinSineOfView) {
    // Looking down, the image's upper edge lies ahead; looking up, behind.
    const Eigen::Vector3d edge = rise < 0.0 ? image_up_body : Eigen::Vector3d(-image_up_body);
    ahead = edge - edge.dot(up_body) * up_body;
  }
  const Eigen::Vector3d x = ahead / std::sqrt(ahead.squaredNorm());
  // Two smallest rotations: up to z, then x about z. Neither needs an angle.
  const Eigen::Quaterniond to_level = smallest_rotation(up_body, Eigen::Vector3d::UnitZ());
  Eigen::Vector3d level_x = to_level.toRotationMatrix() * x;
  level_x.z() = 0.0;
  level_x /= std::sqrt(level_x.squaredNorm());
  // A half turn must be about z too, which smallest_rotation() does not promise.
  const Eigen::Quaterniond to_heading = level_x.x() < -1.0 + 1e-9
                                            ? Eigen::Quaterniond(0.0, 0.0, 0.0, 1.0)
                                            : smallest_rotation(level_x, Eigen::Vector3d::UnitX());
  up_body_ = up_body;
  q_odom_body_ = to_heading * to_level;
  is_fixed_ = true;
}

Eigen::Quaterniond GravityFrame::q_odom_body(const Eigen::Vector3d& up_body) const {
  CHECK(is_fixed_, "the heading is fixed before it is used");
  return q_odom_body_ * smallest_rotation(up_body, up_body_);
}

}  // namespace tof
