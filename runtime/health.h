// SPDX-License-Identifier: BSD-3-Clause
// Collects what health_t says: state, flags, durations of the stages of the work step. Inputs are
// added from the bus.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/quantiles.h"
#include "ladder_msgs/health_t.hpp"
#include "runtime/bus.h"

namespace runtime {

class Health {
 public:
  explicit Health(std::int8_t service);

  void set_config_hash(std::int64_t hash) { message_.config_hash = hash; }

  void set_state(std::int8_t state) { message_.state = state; }
  /// flag: health_t FLAG_*.
  void set_flag(std::int64_t flag, bool on) {
    message_.flags = on ? message_.flags | flag : message_.flags & ~flag;
  }
  void set_head_state(const std::array<std::int8_t, 4>& state);
  void count_step() { ++message_.steps; }

  /// Duration of one stage of the work step; stages are numbered from 0 in their order.
  void add_stage_us(std::size_t stage, std::int64_t duration_us);

  /// The message as of now, with the bus' counts; seq advances.
  const ladder_msgs::health_t& snapshot(std::int64_t utime_us, const Bus& bus);

 private:
  ladder_msgs::health_t message_{};
  std::vector<base::Quantiles> stages_;
};

/// Adds the wall time from its construction to its destruction to a stage.
class StageTimer {
 public:
  StageTimer(Health& health, std::size_t stage);
  ~StageTimer();
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  Health& health_;
  std::size_t stage_;
  std::int64_t start_us_;
};

}  // namespace runtime
