// SPDX-License-Identifier: BSD-3-Clause
// How well the heads saw each true rung: clean pixels on it, and over which share of its length.
#pragma once

#include <bitset>
#include <vector>

#include "simulator/head_renderer.h"
#include "simulator/scene.h"

namespace simulator {

/// True rungs, and which geom of the rendered model belongs to which of them (-1 = none).
struct LabelledRungs {
  const Scene& scene;
  const std::vector<int>& rung_of_geom;
};

class RungVisibility {
 public:
  static constexpr int kNumStretches = 20;  ///< a rung counts as seen by twentieths of its length

  explicit RungVisibility(std::size_t num_rungs) : rungs_(num_rungs) {}

  void clear();
  /// Adds one head's newest frame.
  void add(const LabelledRungs& rungs, const HeadRenderer& head,
           const Eigen::Isometry3d& T_world_body, const HeadImage& image);

  int hits(std::size_t rung) const { return rungs_[rung].hits; }
  float visible_share(std::size_t rung) const {
    return static_cast<float>(rungs_[rung].seen.count()) / kNumStretches;
  }

 private:
  struct Seen {
    int hits = 0;
    std::bitset<kNumStretches> seen;
  };
  std::vector<Seen> rungs_;
};

}  // namespace simulator
