// SPDX-License-Identifier: BSD-3-Clause
#include "climb/body_shift.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace climb {
namespace {

constexpr int kNumChecked = 8;  // points on the way
constexpr double kMaxShiftSpeed_m_s = 0.3;

}  // namespace

BodyShift::BodyShift(const RobotParams& robot, const MotionParams& motion)
    : kinematics_(robot), motion_(motion) {}

bool BodyShift::begin(const PerLeg<LegAngles>& told_rad, const PerLeg<LegAngles>& measured_rad,
                      const BodyMove& move) {
  from_rad_ = told_rad;
  const Eigen::Isometry3d T_moved_body = move.pose().inverse();
  double longest_m = 0.0;
  for (const Leg leg : kLegs) {
    from_m_[leg] = kinematics_.foot_m(leg, told_rad[leg]);
    way_m_[leg] = T_moved_body * kinematics_.foot_m(leg, measured_rad[leg]) - from_m_[leg];
    longest_m = std::max(longest_m, way_m_[leg].norm());
    for (int i = 1; i <= kNumChecked; ++i) {
      const double part = static_cast<double>(i) / kNumChecked;
      if (!kinematics_.inverse(leg, from_m_[leg] + part * way_m_[leg]).reachable()) return false;
    }
  }
  const double scale = std::max(longest_m, 1e-3);
  line_ = Line(Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX(), kMaxShiftSpeed_m_s / scale,
               motion_.cartesian_m_s2 / scale, motion_.body_shift_s);
  clock_.restart();
  active_ = line_.valid();
  return active_;
}

JointSample BodyShift::sample(Leg leg, double t_s) const {
  const LineSample part = line_.at(t_s);
  const Eigen::Vector3d foot_m = from_m_[leg] + part.point_m.x() * way_m_[leg];
  const LegSolution solution = kinematics_.inverse(leg, foot_m);
  JointSample sample;
  sample.angles_rad = solution.reachable() ? solution.angles_rad : from_rad_[leg];
  if (solution.reachable()) {
    const Eigen::Matrix3d inverse = kinematics_.jacobian(leg, solution.angles_rad).inverse();
    sample.velocity_rad_s = inverse * (part.velocity_m_s.x() * way_m_[leg]);
    // The bend is small.
    sample.acceleration_rad_s2 = inverse * (part.acceleration_m_s2.x() * way_m_[leg]);
  }
  return sample;
}

void BodyShift::step(double dt_s, bool stop) {
  if (!active_) return;
  // The stop is as hard as the fastest leg allows; the others bend less.
  Leg fastest = kFrontLeft;
  double most = -1.0;
  for (const Leg leg : kLegs) {
    const double speed = sample(leg, clock_.path_time_s()).velocity_rad_s.cwiseAbs().maxCoeff();
    if (speed > most) {
      most = speed;
      fastest = leg;
    }
  }
  struct Path {
    const BodyShift& shift;
    Leg leg;
    JointSample at(double t_s) const { return shift.sample(leg, t_s); }
  };
  clock_.advance(dt_s, stop, Path{*this, fastest}, leg_limits(kinematics_, fastest));
  if (!stop && clock_.path_time_s() >= line_.duration_s()) active_ = false;
}

}  // namespace climb
