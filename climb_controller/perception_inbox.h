// SPDX-License-Identifier: BSD-3-Clause
// Which messages of perception the controller believes: sound, in order, not too old. What is
// refused changes nothing, so silence and nonsense end the same way: the rungs grow too old.
#pragma once

#include <cstdint>
#include <vector>

#include "base/clock.h"
#include "climb/attitude.h"
#include "climb/controller_io.h"
#include "ladder_msgs/imu_t.hpp"
#include "ladder_msgs/ladder_t.hpp"
#include "runtime/bus.h"

namespace climb_controller {

/// Rungs as the controller looks at them.
struct RungsSnapshot {
  std::vector<climb::RungView> rungs;
  std::vector<climb::StretchView> stretches;
  bool confirmed = false;
  std::int64_t received_us = -1'000'000'000;  ///< monotonic

  /// So that assigning allocates nothing.
  void reserve();
  climb::LadderView view() const { return {rungs, stretches, 0.0, confirmed}; }
};

/// Copies what the controller uses; the message must have passed check_values().
void to_snapshot(const ladder_msgs::ladder_t& message, RungsSnapshot& snapshot);

struct PerceptionParams {
  std::int64_t max_age_us = 300'000;   ///< of a measurement at receipt, by the wall clock
  std::int64_t max_ahead_us = 50'000;  ///< a measurement may lie so far in the future
};

class RungsInbox {
 public:
  explicit RungsInbox(const PerceptionParams& params) : params_(params) {}

  /// kNone: `snapshot` is new. Also judges values and order, for messages that did not come
  /// through a bus.
  runtime::Reject accept(const ladder_msgs::ladder_t& message, const base::Now& now,
                         RungsSnapshot& snapshot);

  std::int64_t num_refused() const { return num_refused_; }

 private:
  runtime::Reject judge(const ladder_msgs::ladder_t& message, const base::Now& now);

  PerceptionParams params_;
  runtime::StreamPosition position_;
  runtime::InputCounts counts_;
  std::int64_t num_refused_ = 0;
};

/// The newest orientation, with the time of its receipt.
struct ImuSnapshot {
  climb::ImuReading reading;
  std::int64_t received_us = -1'000'000'000;  ///< monotonic
};

class ImuInbox {
 public:
  explicit ImuInbox(const climb::AttitudeParams& params) : attitude_(params) {}

  /// False: nothing new; the reading grows old.
  bool accept(const ladder_msgs::imu_t& message, std::int64_t now_us);
  const ImuSnapshot& newest() const { return newest_; }

 private:
  climb::Attitude attitude_;
  ImuSnapshot newest_;
};

}  // namespace climb_controller
