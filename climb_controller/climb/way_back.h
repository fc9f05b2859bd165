// SPDX-License-Identifier: BSD-3-Clause
// The rungs that claws have left on the way up, which is how the robot comes down: what its own
// legs and belly hide it cannot see, but it knows what bore it. A claw that takes such a rung again
// is confirmed and pulled at as ever.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "climb/grasp_choice.h"
#include "climb/limb_cycle.h"

namespace climb {

class WayBack {
 public:
  static constexpr int kFirstId = 1'000'000;    ///< of its rungs; perception does not count so far
  static constexpr std::size_t kMaxRungs = 64;  ///< then the lowest are forgotten
  static constexpr std::size_t kMaxSeen = 256;  ///< rungs of one view that are looked at

  explicit WayBack(const ClimbParams& params);

  /// Odom begins anew.
  void clear();

  /// On the way up this claw leaves the place (odom) that bore it.
  void leave(Leg leg, const LimbGoal& place);

  /// On the way down a claw holds again, here (odom): by as much as this place is off by now, all
  /// others are.
  void return_to(Leg leg, const Eigen::Vector3d& held_m);

  /// The rungs of the way back, each where claws had it; of those seen (odom) only others.
  void look(const LadderView& seen);

  /// As looked at last. Valid until the next look().
  LadderView view() const { return {rungs_, stretches_, seen_age_s_, is_ladder_}; }

  int num_rungs() const { return static_cast<int>(known_.size()); }

 private:
  /// Places are told as they were before odometry drifted.
  struct Known {
    int id = 0;
    std::array<std::optional<Eigen::Vector3d>, 2> places_m;  ///< right, left
    Eigen::Vector3d axis = Eigen::Vector3d::UnitY();         ///< unit, to the left
    double radius_m = 0.0;

    const Eigen::Vector3d& any_m() const { return places_m[0] ? *places_m[0] : *places_m[1]; }
  };
  Known* find(const Eigen::Vector3d& point_m);
  void show(const Known& known);

  ClawParams claw_;
  GraspChoiceParams params_;
  std::vector<Known> known_;  ///< the oldest first
  int num_ever_ = 0;
  Eigen::Vector3d drift_m_ = Eigen::Vector3d::Zero();  ///< of odometry since
  std::vector<RungView> rungs_;
  std::vector<StretchView> stretches_;
  double seen_age_s_ = 0.0;
  bool is_ladder_ = false;
};

}  // namespace climb
