// SPDX-License-Identifier: BSD-3-Clause
// Motions of one leg as functions of path time: minimum-jerk joint segments (all joints start and
// stop together) and straight lines of a point; and the last cut before a command. Lines of a foot
// in joint space: foot_line.h. Stopping on a path: path_clock.h.
#pragma once

#include "climb/leg_kinematics.h"
#include "climb/params.h"

namespace climb {

/// Where a path is at some path time; derivatives are by path time.
struct JointSample {
  LegAngles angles_rad = LegAngles::Zero();
  LegAngles velocity_rad_s = LegAngles::Zero();
  LegAngles acceleration_rad_s2 = LegAngles::Zero();
};

/// Minimum jerk: 10 u^3 - 15 u^4 + 6 u^5 of u in 0..1, with its derivatives by u.
struct Quintic {
  double value = 0.0;
  double slope = 0.0;      ///< at most 1.875
  double curvature = 0.0;  ///< at most 5.7735 either way
};
Quintic quintic(double u);

/// Seconds to cover `distance` at rest-to-rest minimum jerk within speed and acceleration.
double quintic_duration_s(double distance, double max_speed, double max_acceleration);

/// Limits of the three joints of one leg.
using LegLimits = std::array<JointLimits, kNumLegJoints>;

class JointSegment {
 public:
  JointSegment() = default;  ///< stands at zero

  /// From rest to rest. The duration follows from the limits, at least min_duration_s.
  /// Not finite ends: valid() is false and it stands at `from` (or zero).
  JointSegment(const LegAngles& from_rad, const LegAngles& to_rad, const LegLimits& limits,
               double min_duration_s = 0.0);

  bool valid() const { return valid_; }
  double duration_s() const { return duration_s_; }
  /// Before 0 the start, after the duration the end; NaN = the start.
  JointSample at(double t_s) const;

 private:
  LegAngles from_rad_ = LegAngles::Zero();
  LegAngles to_rad_ = LegAngles::Zero();
  double duration_s_ = 0.0;
  bool valid_ = true;
};

/// A point on a straight line, minimum jerk.
struct LineSample {
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration_m_s2 = Eigen::Vector3d::Zero();
};

/// Straight, in any frame; the caller turns points into the body frame where the body moves.
class Line {
 public:
  Line() = default;
  Line(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m, double max_speed_m_s,
       double max_acceleration_m_s2, double min_duration_s = 0.0);

  bool valid() const { return valid_; }
  double duration_s() const { return duration_s_; }
  double length_m() const { return (to_m_ - from_m_).norm(); }
  LineSample at(double t_s) const;

 private:
  Eigen::Vector3d from_m_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d to_m_ = Eigen::Vector3d::Zero();
  double duration_s_ = 0.0;
  bool valid_ = true;
};

/// A stop ends within this time (contract), so no path is planned faster than joints may stop in
/// it.
inline constexpr double kMaxStop_s = 0.150;

/// The limits of a leg's three joints, for planning.
LegLimits leg_limits(const LegKinematics& kinematics, Leg leg);

/// The last cut before a command: at most v dt from `last`, within the joint limits. A wish that is
/// not finite becomes `last`.
LegAngles clamp_step(const LegAngles& last_rad, const LegAngles& wish_rad, const LegLimits& limits,
                     double dt_s);

}  // namespace climb
