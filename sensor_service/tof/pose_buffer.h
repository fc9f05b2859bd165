// SPDX-License-Identifier: BSD-3-Clause
// Poses of the body by time, from odometry; bounded. Answers the pose at a head's own time.
#pragma once

#include <optional>

#include "tof/pose.h"
#include "tof/time_history.h"

namespace tof {

class PoseBuffer {
 public:
  explicit PoseBuffer(const PoseParams& params) : history_(params) {}

  /// False: not sound, or not newer than the last; nothing changes.
  bool push(std::int64_t utime_us, const Pose& T_odom_body) {
    return is_sound(T_odom_body) && history_.push(utime_us, T_odom_body);
  }

  /// Interpolated or, for a short while, extrapolated; none when no pose is near enough.
  std::optional<Pose> at(std::int64_t utime_us) const {
    const auto bracket = history_.at(utime_us);
    if (!bracket) return std::nullopt;
    return interpolate(*bracket->a, *bracket->b, bracket->fraction);
  }

  std::optional<Pose> newest() const {
    if (history_.size() == 0) return std::nullopt;
    return history_.newest_value();
  }

  void clear() { history_.clear(); }

 private:
  TimeHistory<Pose> history_;
};

}  // namespace tof
