// SPDX-License-Identifier: BSD-3-Clause
// ODrives behind ServoBus. Simpler than CiA 402 and weaker: no SYNC, no read-back, and on loss of
// the master its watchdog disarms the motor. So hold_on_loss is false, and a climbing policy
// refuses it; it is good for the ground and for the bench. The drive's watchdog
// (axis.config.watchdog) and the cyclic encoder and current messages are set in the drive
// beforehand.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "can/axis_config.h"
#include "can/bus_line.h"
#include "can/odrive.h"
#include "can/servo_bus.h"

namespace can {

struct OdriveParams {
  std::vector<AxisConfig> axes;  ///< 1..32; node_id 1..63; counts_per_rad is not used: revolutions
  std::int64_t cycle_us = 10'000;
  std::int64_t listen_us = 300'000;
  int drive_lost_ms = 250;    ///< heartbeat every 100 ms
  int max_missed_cycles = 3;  ///< encoder estimates at least once a cycle
  std::int64_t walk_timeout_us = 1'000'000;
  double torque_constant_Nm_A = 0.05;  ///< of the motor, > 0
  BusLineParams line;
};

/// "" or the violated relation in words.
std::string check(const OdriveParams& params);

class OdriveBus : public ServoBus {
 public:
  OdriveBus(const OdriveParams& params, Transport& transport, FlightRecorder* recorder = nullptr);

  int num_axes() const override { return static_cast<int>(axes_.size()); }
  BusPhase phase() const override { return phase_; }
  Capabilities capabilities() const override { return capabilities_; }
  std::span<const Fault> faults() const override { return faults_.all(); }
  std::span<const ObjectIssue> issues() const override { return {}; }

  bool configure() override;
  bool enable() override;
  bool disable() override;
  /// kQuickStop holds the last targets as kHold does: the protocol has no ramp of its own.
  bool stop(StopKind kind) override;
  bool rearm() override;
  void poll(std::int64_t now_us) override;
  void exchange(std::int64_t now_us, const Targets& targets,
                std::span<AxisFeedback> feedback) override;

 private:
  struct Axis {
    AxisConfig config;
    odrive::AxisState wanted = odrive::AxisState::kIdle;
    odrive::AxisState reported = odrive::AxisState::kUndefined;
    bool has_heartbeat = false;
    std::int64_t heartbeat_us = 0;
    std::uint32_t error = 0;
    bool has_position = false;
    bool is_fresh = false;
    bool was_fresh = false;
    int num_missed = 0;
    float position_rev = 0;
    float current_A = 0;
    bool has_current = false;
    bool expects_torque = false;
    odrive::InputPos command;
    odrive::InputPos offered;
  };

  void enter(BusPhase phase);
  void begin_phase();
  void advance();
  void receive_all();
  bool take(Axis& axis, int index, const CanFrame& frame);
  void watch(bool is_cycle);
  void fill(std::span<AxisFeedback> feedback) const;
  void send_cycle(const Targets& targets);
  void accept_targets(const Targets& targets);
  bool offer(Axis& axis, const AxisTarget& target) const;
  void request(odrive::AxisState state);
  bool is_cycling() const;
  bool all_heard() const;
  bool all_in(odrive::AxisState state) const;
  bool is_late() const { return now_us_ - phase_since_us_ > params_.walk_timeout_us; }

  OdriveParams params_;
  FaultLog faults_;
  FlightRecorder* recorder_;
  BusLine line_;
  std::vector<Axis> axes_;
  std::array<int, 64> axis_of_node_{};
  Capabilities capabilities_;
  std::int64_t now_us_ = 0;
  BusPhase phase_ = BusPhase::kIdle;
  BusPhase after_listening_ = BusPhase::kConfiguring;
  bool has_phase_begun_ = true;
  bool is_configured_ = false;
  std::int64_t phase_since_us_ = 0;
};

}  // namespace can
