// SPDX-License-Identifier: BSD-3-Clause
// Node clouds of a parametric ladder and its surroundings, with exact truth: what ddgng would hand
// to the ladder search, without running it. Points are drawn on the fronts of bars as four heads
// see them, with range noise; nodes win the points nearest to them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "base/rng.h"
#include "ladder/node_cloud.h"

namespace test_support {

/// A piece of surface to draw points on.
struct Surface {
  Eigen::Vector3d end0_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d end1_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d across = Eigen::Vector3d::UnitZ();  ///< direction of the height of a flat one
  double height_m = 0.028;                            ///< diameter of a round one
  bool is_round = false;
  int plane = -1;        ///< index of the plane it belongs to, -1 = off every plane
  double density = 1.0;  ///< of its points; less where it is seen at a flat angle
};

struct RungTruth {
  Eigen::Vector3d end0_m;  ///< inner face of the left rail
  Eigen::Vector3d end1_m;
  bool is_sound = true;
};

struct LadderShape {
  int num_rungs = 8;
  double spacing_m = 0.30;
  double first_height_m = 0.25;
  double clear_width_m = 0.40;
  double rung_diameter_m = 0.028;
  double rail_width_m = 0.010;
  double distance_m = 1.0;     ///< from the body, along x
  double yaw_rad = 0.0;        ///< of the ladder's plane
  double tilt_rad = 0.0;       ///< top away from the robot
  int missing_rung = -1;       ///< index, -1 = none
  int stub_rung = -1;          ///< reaches only 60 % from the left rail
  int bent_rung = -1;          ///< right end 70 mm low, sags 50 mm
  int tilted_rung = -1;        ///< right end 50 mm low
  double tread_depth_m = 0.0;  ///< > 0: level boards so deep instead of rungs
};

class LadderScene {
 public:
  explicit LadderScene(std::uint64_t seed) : seed_(seed) {}

  void add_ladder(const LadderShape& shape);
  void add_bar(const Eigen::Vector3d& end0_m, const Eigen::Vector3d& end1_m, double diameter_m);
  /// A flat strip of the given height.
  void add_board(const Eigen::Vector3d& end0_m, const Eigen::Vector3d& end1_m, double height_m);
  /// A flat strip lying level, going `depth_m` away from the robot.
  void add_shelf_board(const Eigen::Vector3d& end0_m, const Eigen::Vector3d& end1_m,
                       double depth_m);
  /// A level board: its front edge, and its top or underside as the heads see it.
  void add_tread(const Eigen::Vector3d& end0_m, const Eigen::Vector3d& end1_m, double height_m,
                 double depth_m);
  /// An upright rectangle across the x axis; as a plane known to the segmentation or not.
  void add_front(double x_m, double half_width_m, double from_z_m, double to_z_m, bool as_plane);
  void add_stairs(double x_m, int num_steps);
  void add_shelf(double x_m);

  /// Frame `frame` of the scene, nodes drawn anew.
  ladder::NodeCloud cloud(int frame) const;

  double noise_sigma_m = 0.007;
  double node_spacing_m = 0.012;
  double points_per_m2 = 25000.0;  ///< of one frame
  std::vector<RungTruth> truth;

 private:
  std::uint64_t seed_;
  std::vector<Surface> surfaces_;
  int num_planes_ = 0;
};

/// Turns about z, then moves.
ladder::NodeCloud moved(const ladder::NodeCloud& cloud, double yaw_rad,
                        const Eigen::Vector3d& by_m);

}  // namespace test_support
