// SPDX-License-Identifier: BSD-3-Clause
// CiA 402 drives in cyclic synchronous position mode behind ServoBus: RPDOs, then SYNC each cycle,
// the master's heartbeat, configuration by SDO, and every watch of the wire contract. Speaks only
// through the transport handed in, by the time handed in.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "can/bus_line.h"
#include "can/cia402_axis.h"
#include "can/cia402_objects.h"
#include "can/servo_bus.h"
#include "can/transport.h"

namespace can {

class Cia402Bus final : public ServoBus {
 public:
  /// `params` pass check(); transport and recorder (may be null) outlive the bus.
  Cia402Bus(const Cia402Params& params, Transport& transport, FlightRecorder* recorder = nullptr);

  int num_axes() const override { return static_cast<int>(axes_.size()); }
  BusPhase phase() const override { return phase_; }
  Capabilities capabilities() const override { return capabilities_; }
  std::span<const Fault> faults() const override { return faults_.all(); }
  std::span<const ObjectIssue> issues() const override { return issues_; }

  bool configure() override;
  bool enable() override;
  bool disable() override;
  bool stop(StopKind kind) override;
  bool rearm() override;
  void poll(std::int64_t now_us) override;
  void exchange(std::int64_t now_us, const Targets& targets,
                std::span<AxisFeedback> feedback) override;

  /// Frames with a wrong length, identifier or format since construction.
  std::uint64_t num_malformed() const { return line_.num_malformed(); }

 private:
  void enter(BusPhase phase);
  void begin_phase();
  void advance();
  void advance_configuration();
  void finish_configuration();
  void advance_starting();
  void advance_rearming();
  void advance_enabling();
  void advance_disabling();
  void hold();
  bool is_late() const;
  bool is_cycling() const;
  bool is_known(std::uint8_t node) const;

  void receive_all();
  void take(const ReceivedFrame& received);
  void watch_time();
  void send_cycle(const Targets& targets);
  void accept_targets(const Targets& targets);
  void send_heartbeat_if_older(std::int64_t age_us);
  void send_to_all(cia402::NmtCommand command);
  void set_goal(cia402::Goal goal);

  Cia402Params params_;
  FaultLog faults_;
  FlightRecorder* recorder_;
  BusLine line_;
  std::vector<Cia402Axis> axes_;
  std::array<int, 128> axis_of_node_{};
  std::vector<ObjectIssue> issues_;
  Capabilities capabilities_;

  std::int64_t now_us_ = 0;
  BusPhase phase_ = BusPhase::kIdle;
  BusPhase after_listening_ = BusPhase::kConfiguring;
  bool has_phase_begun_ = true;
  std::int64_t phase_since_us_ = 0;
  bool is_starting_ = false;    ///< kConfiguring: objects are done, nodes are being started
  bool is_speaking_ = false;    ///< no other master was heard; the heartbeat runs
  bool was_sync_sent_ = false;  ///< in the last cycle
  std::int64_t heartbeat_us_ = 0;
  std::int64_t cycle_us_ = 0;  ///< time of the last cycle that was sent
};

}  // namespace can
