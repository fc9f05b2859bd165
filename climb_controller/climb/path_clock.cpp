// SPDX-License-Identifier: BSD-3-Clause
#include "climb/path_clock.h"

#include <algorithm>
#include <cmath>

namespace climb {

// Joint acceleration is q'' r^2 + q' r' (r = rate, primes of q by path time): each joint bounds r'
// from both sides. As |q''| is within the limit and r <= 1, r' = 0 is always allowed.
void PathClock::turn(double step_s, bool stop, const JointSample& here, const LegLimits& limits) {
  double low = -rate_ / step_s;
  double high = (1.0 - rate_) / step_s;
  for (int joint = 0; joint < kNumLegJoints; ++joint) {
    const double slope = std::abs(here.velocity_rad_s[joint]);
    const double limit = limits[joint].max_acceleration_rad_s2;
    const double bend = here.acceleration_rad_s2[joint] * rate_ * rate_ *
                        (here.velocity_rad_s[joint] < 0.0 ? -1.0 : 1.0);
    if (!(slope > 1e-9)) continue;  // does not move: bounds nothing
    low = std::max(low, (-limit - bend) / slope);
    high = std::min(high, (limit - bend) / slope);
  }
  const double change = stop ? std::min(low, 0.0) : std::max(high, 0.0);
  const double next_rate = std::clamp(rate_ + change * step_s, 0.0, 1.0);
  path_time_s_ += 0.5 * (rate_ + next_rate) * step_s;
  rate_ = next_rate;
}

}  // namespace climb
