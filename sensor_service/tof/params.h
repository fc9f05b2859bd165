// SPDX-License-Identifier: BSD-3-Clause
// Every number of this library that may be chosen. What belongs to a head (intrinsics, ranges,
// extrinsics) comes with its frames instead.
#pragma once

#include <string>

namespace tof {

/// Which pixels are believed.
struct FilterParams {
  int min_confidence = 1;       ///< 0..255; below it a pixel is dropped; heads without: no effect
  double flying_step_m = 0.05;  ///< depth step that makes an edge, up to 1 m away (recipe row f)
  double flying_step_ratio = 0.05;  ///< of the distance, 0..0.49: the step grows with it beyond
                                    ///< flying_step_m / flying_step_ratio (noise 1 % of range)
  bool drop_isolated = true;        ///< drop pixels without a 4-neighbour at their own depth
  /// Where the confidence of a white wall has fallen to half: 255 / (1 + (distance / this)^2).
  /// Tells wrapped distances where wrap_range_m > 0; 0 = off. Belongs to the make of head (ours:
  /// simulator).
  double white_half_confidence_m = 4.47;
};

/// When a head counts as alive, and what a new recording is.
struct HeadParams {
  double period_s = 1.0 / 15.0;  ///< of a head, until it is measured
  int awaited_at_start = 4;      ///< 1..4: heads 0 to this - 1 are in the first cloud, unless one
                                 ///< delivers twice before all have
  double dead_periods = 3.0;     ///< silence, in periods of the head, after which it is dead
  double backward_reset_s =
      1.0;  ///< time going back by more is a new recording; less is a late frame
  double forward_reset_s = 10.0;  ///< time going ahead by more is a new recording
};

/// Direction of up from the inertial unit.
struct GravityParams {
  double time_constant_s = 0.5;  ///< of the accelerometer's low-pass; the gyro serves below it
  double gravity_m_s2 = 9.81;
  double trust_m_s2 = 2.0;  ///< |length - gravity| at which a sample has no weight left
  double max_gap_s = 0.5;   ///< a longer silence restarts the estimate
};

/// Looking up the pose of a given time.
struct PoseParams {
  int capacity = 512;                ///< poses kept, oldest dropped
  double max_gap_s = 0.2;            ///< between two poses, to interpolate
  double max_extrapolation_s = 0.1;  ///< beyond the newest (or before the oldest) pose
};

/// The robot's own limbs, which its heads see. Lengths as in climb.robot.
struct LimbParams {
  bool drop = true;  ///< pixels on them, once their joint angles are known
  double hip_x_m = 0.25;
  double hip_y_m = 0.10;
  double abduction_m = 0.05;
  double thigh_m = 0.22;
  double shank_m = 0.24;
  double wrist_rad = 0.67;
  double thigh_radius_m = 0.020;
  double shank_radius_m = 0.012;
  double margin_m = 0.008;  ///< noise, mounting and the age of the angles
};

struct TofParams {
  FilterParams filter;
  LimbParams limbs;
  HeadParams heads;
  GravityParams gravity;
  PoseParams poses;
  int max_points = 60000;  ///< of a cloud, 1..400000; more are thinned evenly
};

/// "" or the violated relation in words.
std::string check(const TofParams& params);

}  // namespace tof
