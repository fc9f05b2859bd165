// SPDX-License-Identifier: BSD-3-Clause
// A Cia402Bus and its scripted drives in virtual time, one millisecond at a time.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "can/cia402_bus.h"
#include "fake_line.h"
#include "scripted_drive.h"

namespace can {

class BusRig {
 public:
  explicit BusRig(int num_axes, Cia402Params base = {}) : params(std::move(base)) {
    for (int i = 0; i < num_axes; ++i) add_axis(static_cast<std::uint8_t>(i + 1));
  }

  void add_axis(std::uint8_t node) {
    AxisConfig axis;
    axis.node_id = node;
    axis.counts_per_rad = 1000.0;
    axis.min_rad = -2.0;
    axis.max_rad = 2.0;
    params.axes.push_back(axis);
    drives.emplace_back(node);
  }

  /// To be called after the last change of params.
  void build() {
    bus.reset();
    bus = std::make_unique<Cia402Bus>(params, line, &recorder);
    feedback.resize(params.axes.size());
    targets.resize(params.axes.size());
  }

  /// One cycle: the bus first, then 10 ms of the drives.
  void cycle() {
    Targets now{time_us, targets};
    if (targets_age_us != 0) now.time_us -= targets_age_us;
    bus->exchange(time_us, now, feedback);
    for (int i = 0; i < 10; ++i) {
      deliver();
      time_us += 1000;
      for (ScriptedDrive& drive : drives) {
        for (const CanFrame& frame : drive.tick(time_us / 1000)) line.put(frame);
      }
      if (i < 9 && polls_between) bus->poll(time_us);
    }
    deliver();
    if (bus->phase() == BusPhase::kEnabled && follows) hold_measured();
  }

  void run_ms(int duration_ms) {
    for (int i = 0; i < duration_ms / 10; ++i) cycle();
  }

  bool run_until(BusPhase phase, int limit_ms) {
    for (int i = 0; i < limit_ms / 10 && bus->phase() != phase; ++i) cycle();
    return bus->phase() == phase;
  }

  bool bring_up() {
    if (!bus) build();
    cycle();
    bus->configure();
    return run_until(BusPhase::kReady, 5000);
  }

  bool bring_to_enabled() {
    if (!bring_up()) return false;
    bus->enable();
    return run_until(BusPhase::kEnabled, 1000);
  }

  void hold_measured() {
    for (std::size_t i = 0; i < targets.size(); ++i) {
      if (targets[i].position_rad != targets[i].position_rad) {
        targets[i].position_rad = feedback[i].position_rad;
      }
    }
  }

  bool has(FaultCause cause, int axis) const {
    for (const Fault& fault : bus->faults()) {
      if (fault.cause == cause && fault.axis == axis) return true;
    }
    return false;
  }

  std::string fault_names() const {
    std::string names;
    for (const Fault& fault : bus->faults()) {
      names += std::string(name(fault.cause)) + " " + std::to_string(fault.axis) + "; ";
    }
    return names;
  }

  Cia402Params params;
  FakeLine line;
  FlightRecorder recorder;
  std::vector<ScriptedDrive> drives;
  std::unique_ptr<Cia402Bus> bus;
  std::vector<AxisFeedback> feedback;
  std::vector<AxisTarget> targets;
  std::int64_t time_us = 1'000'000;
  std::int64_t targets_age_us = 0;
  bool polls_between = true;
  bool follows = true;  ///< once enabled, targets that were never set become the measured position

 private:
  /// What the bus has sent since the last call reaches every drive; answers come back.
  void deliver() {
    for (; num_delivered_ < line.sent.size(); ++num_delivered_) {
      const CanFrame frame = line.sent[num_delivered_];
      for (ScriptedDrive& drive : drives) {
        for (const CanFrame& answer : drive.hear(frame)) line.put(answer);
      }
    }
  }

  std::size_t num_delivered_ = 0;
};

}  // namespace can
