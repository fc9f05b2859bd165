// SPDX-License-Identifier: BSD-3-Clause
// The body's pose in the odom frame from the feet that hold and the IMU's orientation. Each foot
// keeps the odom point of its rung; no drift arises while the same feet hold. A new foot still
// slides in its claw: it counts little, and follows the others, until it has settled.
#pragma once

#include <optional>

#include <Eigen/Geometry>

#include "climb/leg_kinematics.h"
#include "climb/params.h"

namespace climb {

struct OdometryInput {
  PerLeg<LegAngles> angles_rad = {LegAngles::Zero(), LegAngles::Zero(), LegAngles::Zero(),
                                  LegAngles::Zero()};
  PerLeg<double> weight = {0.0, 0.0, 0.0, 0.0};  ///< 0 = foot is free .. 1 = it holds
  Eigen::Quaterniond q_odom_body = Eigen::Quaterniond::Identity();  ///< IMU, unit
  double dt_s = 0.01;                                               ///< since the last input
};

struct OdometryEstimate {
  Eigen::Vector3d position_odom_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_odom_body = Eigen::Quaterniond::Identity();
  double position_sigma_m = 0.0;  ///< per axis
  double orientation_sigma_rad = 0.0;
  int num_feet = 0;            ///< that took part
  std::optional<Leg> slipped;  ///< the foot that disagrees most, if by more than slip_m

  Eigen::Isometry3d T_odom_body() const;
};

class Odometry {
 public:
  Odometry(const RobotParams& robot, const OdometryParams& params);

  /// The next valid input is the first fix: the body's place then is the origin of odom.
  void reset();
  bool fixed() const { return fixed_; }

  /// Takes one cycle in. Input that is not finite, or an orientation that is no rotation, leaves
  /// the estimate as it was (only its error grows).
  const OdometryEstimate& update(const OdometryInput& input);

  const OdometryEstimate& estimate() const { return estimate_; }

  /// Where a holding foot stands in odom; none while it is free.
  std::optional<Eigen::Vector3d> anchor_m(Leg leg) const;

 private:
  struct Anchor {
    bool set = false;
    int num_later = 0;  ///< feet that took hold after this one
    Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
    double variance_m2 = 0.0;
  };
  bool has_settled(Leg leg) const { return anchors_[leg].num_later >= params_.settled_after; }
  void locate(const OdometryInput& input);
  void find_slip(const OdometryInput& input);
  Eigen::Vector3d seat_odom_m(const OdometryInput& input, Leg leg) const;
  void keep_anchors(const OdometryInput& input, bool is_first);
  void set_anchor(Leg leg, const Eigen::Vector3d& seat_odom_m, bool is_first);

  LegKinematics kinematics_;
  OdometryParams params_;
  OdometryEstimate estimate_;
  PerLeg<Anchor> anchors_;
  bool fixed_ = false;
};

}  // namespace climb
