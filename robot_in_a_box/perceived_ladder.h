// SPDX-License-Identifier: BSD-3-Clause
// Rungs as perception would tell them, made from the plant's truth: at 15 Hz, in the odom frame,
// with an error per rung that stays and one per message that does not. Heads see the ladder from
// the body, so an error of the body's estimated pose goes into the rungs too, as it does in life.
// No cameras, no cloud.
#pragma once

#include <cstdint>
#include <vector>

#include "base/rng.h"
#include "climb/grasp_choice.h"
#include "simulator/plant/robot_plant.h"

namespace robot_in_a_box {

struct PerceptionParams {
  std::int64_t period_us = 66'667;
  double bias_m = 0.003;        ///< of a rung, uniform +- per axis, for its life
  double jitter_m = 0.001;      ///< of a rung in one message, uniform +- per axis
  double range_m = 1.0;         ///< rungs so far above and below the body are seen
  double stretch_end_m = 0.02;  ///< so far from either end a claw is kept
};

class PerceivedLadder {
 public:
  PerceivedLadder(const PerceptionParams& params, std::uint64_t seed);

  /// The next message when one is due; false = nothing new. `T_odom_body` is what the controller
  /// publishes.
  bool update(std::int64_t now_us, const simulator::RobotPlant& plant,
              const Eigen::Isometry3d& T_odom_body);

  climb::LadderView view() const;
  std::int64_t received_us() const { return received_us_; }

  bool silent = false;        ///< perception has stopped
  int withdrawn_rung = -1;    ///< flagged as damaged from now on
  double seen_from_m = -1e9;  ///< rungs nearer than this above the body are not seen

 private:
  void tell(int index, const simulator::LadderRung& rung, const Eigen::Isometry3d& T_odom_world);

  PerceptionParams params_;
  base::Rng rng_;
  std::vector<Eigen::Vector3d> bias_m_;
  std::vector<climb::RungView> rungs_;
  std::vector<climb::StretchView> stretches_;
  std::int64_t next_us_ = 0;
  std::int64_t received_us_ = -1'000'000'000;
};

}  // namespace robot_in_a_box
