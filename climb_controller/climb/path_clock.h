// SPDX-License-Identifier: BSD-3-Clause
// Path time that runs, stops and runs again: a stop never leaves the path, it slows path time down
// as fast as the joints may decelerate (time-optimal along the path).
#pragma once

#include "climb/leg_trajectory.h"

namespace climb {

class PathClock {
 public:
  double path_time_s() const { return path_time_s_; }
  double rate() const { return rate_; }  ///< 1 = as planned, 0 = stands
  bool stands() const { return rate_ <= 0.0; }

  void restart() { *this = PathClock(); }

  /// One cycle on `path` (anything with JointSample at(double) const). stop = slow down; otherwise
  /// speed up again to rate 1. Joints keep |acceleration| within the limits (to 3 %).
  template <typename Path>
  void advance(double dt_s, bool stop, const Path& path, const LegLimits& limits) {
    if (!(dt_s > 0.0)) return;
    if (!stop && rate_ >= 1.0) {
      path_time_s_ += dt_s;
      return;
    }
    const double step_s = dt_s / kNumSteps;
    for (int step = 0; step < kNumSteps; ++step) {
      turn(step_s, stop, path.at(path_time_s_ + 0.5 * rate_ * step_s), limits);
    }
  }

 private:
  static constexpr int kNumSteps = 10;  ///< 1 ms at 100 Hz: bends of short segments are followed

  void turn(double step_s, bool stop, const JointSample& here, const LegLimits& limits);

  double path_time_s_ = 0.0;
  double rate_ = 1.0;
};

}  // namespace climb
