// SPDX-License-Identifier: BSD-3-Clause
// The controller's servo bus on a CAN interface in real time: one cycle per period at absolute
// times, the socket polled in between. Counts what an emulated machine makes of that.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include <poll.h>

#include "can/can_socket.h"
#include "can/cia402_bus.h"

namespace hardware {

inline std::int64_t monotonic_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

/// `num_axes` nodes from 1; counts and limits as the plant's.
inline can::Cia402Params master_params(int num_axes, std::int64_t cycle_us) {
  can::Cia402Params params;
  params.cycle_us = cycle_us;
  for (int axis = 0; axis < num_axes; ++axis) {
    can::AxisConfig config;
    config.node_id = static_cast<std::uint8_t>(axis + 1);
    config.min_rad = -2.6;
    config.max_rad = 2.6;
    if (axis % 4 == 3) {  // a jaw
      config.rated_torque_Nm = config.max_torque_Nm = 6.0;
      config.following_error_rad = 0.5;
    }
    params.axes.push_back(config);
  }
  return params;
}

class RealTimeMaster {
 public:
  RealTimeMaster(const std::string& interface, const can::Cia402Params& params)
      : socket_(can::CanSocketParams{interface}),
        bus_(params, socket_),
        period_us_(params.cycle_us),
        due_us_(monotonic_us()) {
    feedback.resize(params.axes.size());
    targets.resize(params.axes.size());
  }

  can::Cia402Bus& bus() { return bus_; }

  /// Waits for the next deadline, then one cycle. Until enabled the targets follow what is
  /// measured.
  void cycle() {
    due_us_ += period_us_;
    for (std::int64_t now_us = monotonic_us(); now_us < due_us_; now_us = monotonic_us()) {
      pollfd waiting{socket_.fd(), POLLIN, 0};
      ::poll(&waiting, 1, static_cast<int>((due_us_ - now_us) / 1000));
      bus_.poll(monotonic_us());
    }
    const std::int64_t late_us = monotonic_us() - due_us_;
    if (late_us > worst_late_us) worst_late_us = late_us;
    if (late_us > period_us_) {
      ++num_overruns;
      due_us_ += late_us / period_us_ * period_us_;
    }
    ++num_cycles;
    const bool follows = bus_.phase() == can::BusPhase::kEnabled;
    const std::int64_t now_us = monotonic_us();
    bus_.begin_cycle(now_us, feedback);
    if (!follows) {
      for (std::size_t axis = 0; axis < targets.size(); ++axis) {
        targets[axis].position_rad = feedback[axis].position_rad;
      }
    }
    can::Targets all;
    all.time_us = now_us;
    if (follows) all.axes = targets;
    bus_.end_cycle(all);
  }

  void run(double seconds) {
    const auto cycles = static_cast<int>(seconds * 1e6 / static_cast<double>(period_us_));
    for (int i = 0; i < cycles; ++i) cycle();
  }

  bool reach(can::BusPhase wanted, double seconds = 20.0) {
    const std::int64_t end_us = monotonic_us() + static_cast<std::int64_t>(seconds * 1e6);
    while (bus_.phase() != wanted && monotonic_us() < end_us) cycle();
    return bus_.phase() == wanted;
  }

  bool has_fault(can::FaultCause cause) const {
    for (const can::Fault& fault : bus_.faults()) {
      if (fault.cause == cause) return true;
    }
    return false;
  }

  std::string problems() const {
    std::string text = std::string("phase ") + can::name(bus_.phase()) + "\n";
    for (const can::ObjectIssue& issue : bus_.issues()) text += can::describe(issue) + "\n";
    for (const can::Fault& fault : bus_.faults()) {
      text += std::string(can::name(fault.cause)) + " axis " + std::to_string(fault.axis) +
              " detail " + std::to_string(fault.detail) + "\n";
    }
    return text;
  }

  std::vector<can::AxisFeedback> feedback;
  std::vector<can::AxisTarget> targets;
  int num_cycles = 0;
  int num_overruns = 0;  ///< cycles begun more than a period late
  std::int64_t worst_late_us = 0;

 private:
  can::CanSocket socket_;
  can::Cia402Bus bus_;
  std::int64_t period_us_;
  std::int64_t due_us_;
};

}  // namespace hardware
