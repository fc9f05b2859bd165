// SPDX-License-Identifier: BSD-3-Clause
// The rungs that the plant's claws can hold, and when each of them breaks. World frame: z up, x
// into the ladder's plane (x = 0), y to the robot's left. A broken rung is gone at once.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace simulator {

struct LadderRung {
  Eigen::Vector3d end0_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d end1_m = Eigen::Vector3d::Zero();
  double radius_m = 0.014;
  std::int64_t break_at_us = std::numeric_limits<std::int64_t>::max();
  double break_load_N = std::numeric_limits<double>::infinity();
  bool break_on_touch = false;
  bool broken = false;
};

struct LadderParams {
  int num_rungs = 16;
  double spacing_m = 0.30;  ///< lowest rung at one spacing
  double half_width_m = 0.20;
  double rung_radius_m = 0.014;
};

std::vector<LadderRung> straight_ladder(const LadderParams& params);

struct NearestRung {
  int index = -1;
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();  ///< on its axis
  double distance_m = std::numeric_limits<double>::infinity();
};

class RungWorld {
 public:
  explicit RungWorld(std::vector<LadderRung> rungs) : rungs_(std::move(rungs)) {}

  /// The nearest unbroken rung; index -1 when there is none.
  NearestRung nearest(const Eigen::Vector3d& p_world_m) const;

  /// Breaks what is due. `load_N` and `touched` are per rung.
  void update(std::int64_t now_us, std::span<const double> load_N, std::span<const char> touched);

  std::span<const LadderRung> rungs() const { return rungs_; }
  LadderRung& rung(int index) { return rungs_[static_cast<std::size_t>(index)]; }
  const LadderRung& rung(int index) const { return rungs_[static_cast<std::size_t>(index)]; }
  int num_rungs() const { return static_cast<int>(rungs_.size()); }

 private:
  std::vector<LadderRung> rungs_;
};

}  // namespace simulator
