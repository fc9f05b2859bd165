// SPDX-License-Identifier: BSD-3-Clause
// Somebody beside the ladder: sees the robot's truth, hears what the controller says, tells each
// rung that was climbed and writes down at the end what the climb was like.
#pragma once

#include <string>
#include <vector>

#include "ladder_msgs/climb_state_t.hpp"
#include "ladder_msgs/pose_t.hpp"
#include "runtime/bus.h"
#include "simulator/physics/climb_figures.h"

namespace simulator {

class ClimbWitness {
 public:
  /// Listens on this LCM provider. Throws runtime::BusError.
  ClimbWitness(const std::string& url, std::vector<int> unsafe_rungs);

  /// Often; `wall_s` since the start, beside the truth's own time.
  void see(const PlantTruth& truth, double wall_s);
  /// One JSON object; false: the file cannot be written.
  bool write(const std::string& path) const;

 private:
  void tell_progress(const PlantTruth& truth);

  runtime::Bus bus_;
  runtime::Mailbox<ladder_msgs::climb_state_t>& states_;
  runtime::Mailbox<ladder_msgs::pose_t>& poses_;
  ladder_msgs::climb_state_t state_{};
  Eigen::Isometry3d T_odom_body_ = Eigen::Isometry3d::Identity();
  ClimbFigures figures_;
  int told_rungs_ = 0;
  bool top_reached_ = false;
  double simulated_s_ = 0.0;
  double wall_s_ = 0.0;
};

}  // namespace simulator
