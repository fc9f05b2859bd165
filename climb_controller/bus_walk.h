// SPDX-License-Identifier: BSD-3-Clause
// Walks the servo bus to where the controller wants it: brought up at the start, re-armed on the
// operator's reset, enabled, stopped, disabled. Each request is made in the cycle in which the
// bus' phase allows it.
#pragma once

#include <cstdint>

#include "can/servo_bus.h"
#include "climb/controller_io.h"

namespace climb_controller {

struct BusWalkParams {
  std::int64_t bring_up_period_us = 2'000'000;  ///< between attempts to configure, > 0
  std::int64_t reset_timeout_us = 5'000'000;    ///< for the bus to come back, > 0
};

class BusWalk {
 public:
  BusWalk(const BusWalkParams& params, can::ServoBus& bus) : params_(params), bus_(bus) {}

  /// After the bus' begin_cycle(). `unattended`: nothing has ever been armed, so the bus is
  /// configured, and after a failure tried again, without asking.
  void step(std::int64_t now_us, bool unattended);

  /// Faults are forgotten and drives that lost their configuration get it again.
  void begin_reset(std::int64_t now_us);
  bool is_resetting() const { return is_resetting_; }

  /// Without a request a bus that follows targets needs some every cycle: else it holds. One that
  /// is still enabling is no longer wanted.
  void obey(climb::DriveRequest request, bool has_targets);

  /// All objects of all drives are as they should be; capabilities are known.
  bool is_configured() const;
  bool follows_targets() const;

 private:
  void bring_up();
  void advance_reset();
  void quick_stop();

  BusWalkParams params_;
  can::ServoBus& bus_;
  std::int64_t now_us_ = 0;
  std::int64_t next_bring_up_us_ = 0;
  std::int64_t reset_since_us_ = 0;
  bool is_resetting_ = false;
  bool was_configured_again_ = false;  ///< in this reset
  int num_ready_cycles_ = 0;           ///< in this reset
  bool is_quick_stopped_ = false;
};

}  // namespace climb_controller
