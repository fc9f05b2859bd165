// SPDX-License-Identifier: BSD-3-Clause
// What all servo buses do alike, whatever they speak: which request is allowed in which phase,
// listening before the first frame, the order of things within a cycle, targets taken all or none.
// A protocol (cia402_bus.h, odrive_bus.h) adds its frames and how its drives go through a phase.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "can/axis_config.h"
#include "can/bus_line.h"
#include "can/servo_bus.h"
#include "can/transport.h"

namespace can {

struct BusParams {
  std::vector<AxisConfig> axes;              ///< 1..32, node_ids differ
  std::int64_t cycle_us = 10'000;            ///< >= 1000
  std::int64_t listen_us = 300'000;          ///< >= 0, before the first frame: another master here?
  int drive_lost_ms = 250;                   ///< >= 1; a drive's heartbeat
  int max_missed_cycles = 3;                 ///< >= 1: state frames of an axis
  std::int64_t walk_timeout_us = 1'000'000;  ///< > 0: enabling, disabling, starting, fault reset
  BusLineParams line;
};

/// "" or the violated relation in words; what a protocol demands beyond is in its own check().
std::string check_bus(const BusParams& params);

class PhasedBus : public ServoBus {
 public:
  BusPhase phase() const final { return phase_; }
  Capabilities capabilities() const final { return capabilities_; }
  std::span<const Fault> faults() const final { return faults_.all(); }

  bool configure() final;
  bool enable() final;
  bool disable() final;
  bool stop(StopKind kind) final;
  bool rearm() final;
  void poll(std::int64_t now_us) final;
  void begin_cycle(std::int64_t now_us, std::span<AxisFeedback> feedback) final;
  void end_cycle(const Targets& targets) final;

  /// Frames with a wrong length, identifier or format since construction.
  std::uint64_t num_malformed() const { return line_.num_malformed(); }

 protected:
  /// Transport and recorder (may be null) outlive the bus.
  PhasedBus(const BusParams& params, Transport& transport, FlightRecorder* recorder);

  // --- what a protocol adds, in the order of a cycle -------------------------------------------
  virtual bool is_cycling() const = 0;  ///< frames go out in each cycle of this phase
  virtual void take(const ReceivedFrame& received) = 0;
  virtual void watch_cycle() = 0;  ///< once a cycle: who was not heard?
  virtual void watch_time() = 0;   ///< deadlines, in every poll
  virtual void begin_phase() = 0;
  virtual void advance_phase() = 0;
  virtual void fill(std::span<AxisFeedback> feedback) const = 0;
  virtual void send_cycle(const Targets& targets) = 0;
  virtual void keep_alive() {}  ///< after a poll, and where a cycle sends nothing
  virtual void begin_stop(StopKind kind) = 0;
  /// Each axis is offered its target, then all are accepted or none.
  virtual bool offer_target(int axis, const AxisTarget& target) = 0;
  virtual void accept_offered() = 0;
  /// It speaks already: nobody needs to be listened for before the next phase.
  virtual bool skips_listening() const { return false; }

  // --- what it may use for that ------------------------------------------------------------------
  void enter(BusPhase phase);
  void restart_phase_time() { phase_since_us_ = now_us_; }
  bool is_late() const;
  /// Part of send_cycle(): offers the targets if this phase follows any.
  void take_targets(const Targets& targets);

  BusLine& line() { return line_; }
  FaultLog& fault_log() { return faults_; }
  std::int64_t now_us() const { return now_us_; }
  Capabilities& claims() { return capabilities_; }

 private:
  void begin();
  void advance();
  void receive_all();

  std::int64_t cycle_us_;
  std::int64_t listen_us_;
  std::int64_t walk_timeout_us_;
  std::int64_t max_unsent_us_;
  FaultLog faults_;
  FlightRecorder* recorder_;
  BusLine line_;
  Capabilities capabilities_;
  std::int64_t now_us_ = 0;
  bool may_send_ = false;  ///< in this cycle: the last one has left
  BusPhase phase_ = BusPhase::kIdle;
  BusPhase after_listening_ = BusPhase::kConfiguring;
  bool has_phase_begun_ = true;
  std::int64_t phase_since_us_ = 0;
};

}  // namespace can
