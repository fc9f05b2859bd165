// SPDX-License-Identifier: BSD-3-Clause
// What a climb was like, counted by somebody who sees the robot's truth and what the controller
// says that its limbs are about. The same for a climb in virtual time and for a live one.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "simulator/plant/robot_plant.h"

namespace simulator {

/// As the controller tells it.
enum class LimbPhase : std::uint8_t {
  kHolds,  ///< loaded
  kAway,   ///< off, or on its way
  kTries   ///< closing, verifying, loading
};

/// One look; at any rate, 100 Hz sees every try.
struct ClimbMoment {
  std::int64_t now_us = 0;
  const PlantTruth& truth;
  std::array<LimbPhase, kNumLegs> limbs{};
  Eigen::Isometry3d T_odom_body = Eigen::Isometry3d::Identity();  ///< as the controller estimates
  bool climbs = false;  ///< ordered to, and neither at rest again nor stopped
};

struct Figures {
  int rungs_climbed = 0;  ///< rungs that both front claws have come up, at most
  int falls = 0;
  int grasps_tried = 0;
  int grasps_failed = 0;
  int min_support = kNumLegs;  ///< claws on rungs, out of the dock
  double seconds = 0.0;        ///< of climbing
  double peak_joint_torque_Nm = 0.0;
  double peak_grip_N = 0.0;    ///< of one claw on its rung
  double pose_drift_mm = 0.0;  ///< the estimate's largest error since the dock let go
  int num_unsafe_grasps = 0;   ///< tries on a rung that is not sound
};

/// The members of a JSON object, one after another without braces, under the names of Figures with
/// num_ left away.
std::string json_members(const Figures& figures);

class ClimbFigures {
 public:
  /// Indices of rungs that no claw may close on.
  explicit ClimbFigures(std::vector<int> unsafe_rungs = {})
      : unsafe_rungs_(std::move(unsafe_rungs)) {}

  void see(const ClimbMoment& moment);
  const Figures& told() const { return figures_; }

 private:
  void count_tries(const ClimbMoment& moment);
  void count_rungs(const ClimbMoment& moment);
  void measure_drift(const ClimbMoment& moment);

  std::vector<int> unsafe_rungs_;
  Figures figures_;
  std::array<LimbPhase, kNumLegs> before_{};
  std::array<bool, kNumLegs> is_unsafe_try_{};
  std::array<int, kNumLegs> start_rung_ = {-1, -1, -1, -1};
  std::int64_t last_us_ = -1;
  bool has_hung_ = false;
  std::optional<Eigen::Isometry3d> T_odom_world_;  ///< when the dock let go
};

}  // namespace simulator
