// SPDX-License-Identifier: BSD-3-Clause
// CiA 402 drives in cyclic synchronous position mode behind ServoBus: RPDOs, then SYNC each cycle,
// the master's heartbeat, configuration by SDO, and every watch of the wire contract. Speaks only
// through the transport handed in, by the time handed in.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "can/cia402_axis.h"
#include "can/cia402_objects.h"
#include "can/phased_bus.h"

namespace can {

class Cia402Bus final : public PhasedBus {
 public:
  /// `params` pass check(); transport and recorder (may be null) outlive the bus.
  Cia402Bus(const Cia402Params& params, Transport& transport, FlightRecorder* recorder = nullptr);

  int num_axes() const override { return static_cast<int>(axes_.size()); }
  std::span<const ObjectIssue> issues() const override { return issues_; }

 private:
  bool is_cycling() const override;
  void take(const ReceivedFrame& received) override;
  void watch_cycle() override;
  void watch_time() override;
  void begin_phase() override;
  void advance_phase() override;
  void fill(std::span<AxisFeedback> feedback) const override;
  void send_cycle(const Targets& targets) override;
  void keep_alive() override { send_heartbeat_if_older(params_.master_heartbeat_us); }
  void begin_stop(StopKind kind) override;
  bool offer_target(int axis, const AxisTarget& target) override;
  void accept_offered() override;
  bool skips_listening() const override { return is_speaking_; }

  void advance_configuration();
  void finish_configuration();
  void advance_starting();
  void advance_rearming();
  void advance_enabling();
  void advance_disabling();
  void hold();
  bool is_known(std::uint8_t node) const;
  void send_commands(const Targets& targets);
  void send_heartbeat_if_older(std::int64_t age_us);
  void send_to_all(cia402::NmtCommand command);
  void set_goal(cia402::Goal goal);

  Cia402Params params_;
  std::vector<Cia402Axis> axes_;
  std::array<int, 128> axis_of_node_{};
  std::vector<ObjectIssue> issues_;
  bool is_starting_ = false;    ///< kConfiguring: objects are done, nodes are being started
  bool is_speaking_ = false;    ///< no other master was heard; the heartbeat runs
  bool was_sync_sent_ = false;  ///< in the last cycle
  std::int64_t heartbeat_us_ = 0;
  std::int64_t cycle_us_ = 0;  ///< time of the last cycle that was sent
};

}  // namespace can
