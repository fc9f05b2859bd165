// SPDX-License-Identifier: BSD-3-Clause
// Which points a node won, remembered as weight, mean and covariance, apart for each head (heads
// differ by their extrinsic errors). Older frames count less.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "ddgng/params.h"
#include "ddgng/sampler.h"
#include "ddgng/topology.h"
#include "ddgng/winner_search.h"

namespace ddgng {

class Moments {
 public:
  Moments(const GrowingParams& params, int num_slots);

  void clear();
  /// For a slot that a new node moved into.
  void clear(int slot);
  /// Once per frame, before its signals.
  void forget();
  /// The slot won this point, at this squared distance; beyond the gate it is not counted.
  void add(int slot, int head, const Eigen::Vector3f& point_m, float distance_m2);

  /// The same for each signal and its winners.
  void add(std::span<const Signal> signals, const Winners* winners);

  /// Appends the slot's moments in ascending order of head; node is the index to write into them.
  void append(int slot, int node, std::vector<Moment>& moments) const;

 private:
  // Sums in double: at 4 m from the origin a float sum of squares would cost 1 mm of the deviation.
  struct Sums {
    double weight = 0.0;
    double x_m = 0.0, y_m = 0.0, z_m = 0.0;
    double xx_m2 = 0.0, xy_m2 = 0.0, xz_m2 = 0.0, yy_m2 = 0.0, yz_m2 = 0.0, zz_m2 = 0.0;
  };

  float gate_m2_;
  double forget_;
  double min_weight_;
  std::size_t index(int slot, int head) const {
    return static_cast<std::size_t>(slot) * kNumHeads + static_cast<std::size_t>(head);
  }

  std::vector<Sums> sums_;  // over slots and heads; the last one is of points that do not count
};

}  // namespace ddgng
