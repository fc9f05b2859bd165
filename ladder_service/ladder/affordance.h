// SPDX-License-Identifier: BSD-3-Clause
// Where a gripper may close: samples along each trusted rung, refused near rails, other rungs,
// things sticking out, and where nothing was seen; the rest are offered. Both modes.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "ladder/estimate.h"
#include "ladder/measured_bar.h"
#include "ladder/params.h"

namespace ladder {

/// What the affordance asks about a rung beyond what is published.
struct RungSurface {
  Stretches seen;
  Stretches attached;
  double tilt_sin = 0.0;
  double margin_m = 0.0;        ///< its place along itself and its ends are known so well
  bool may_be_offered = false;  ///< old enough (the paper asks more age than for trust)
  bool is_tread = false;        ///< a board
};

/// A line upright beside the rungs, with half its width.
struct RailLine {
  Eigen::Vector3d end0_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d end1_m = Eigen::Vector3d::Zero();
  double half_width_m = 0.0;
};

class Affordance {
 public:
  explicit Affordance(const LadderParams& params);

  /// Fills intervals and grasps of `estimate`; `surfaces` is parallel to its rungs.
  void find(std::span<const RungSurface> surfaces, std::span<const RailLine> rails,
            const Eigen::Vector3d& body_m, LadderEstimate& estimate);

 private:
  void sample(const LadderEstimate& estimate, int rung, const RungSurface& surface,
              std::span<const RailLine> rails);
  Reason reason_at(const LadderEstimate& estimate, int rung, const RungSurface& surface,
                   double along_m) const;
  void find_blocked(const LadderEstimate& estimate, int rung, double margin_m,
                    std::span<const RailLine> rails);
  void offer(int rung, const Eigen::Vector3d& body_m, LadderEstimate& estimate);
  void append_runs(int rung, LadderEstimate& estimate);

  struct Block {
    double from_m = 0.0;
    double to_m = 0.0;
    Reason reason = Reason::kUnknown;
  };

  AffordanceParams params_;
  std::vector<Reason> samples_;
  std::vector<Block> blocked_;
  double step_m_ = 0.0;  ///< of the rung being sampled
};

}  // namespace ladder
