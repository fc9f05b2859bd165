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

#include "can/odrive.h"
#include "can/phased_bus.h"

namespace can {

/// node_ids 1..63; counts_per_rad is not used: revolutions. The drives' heartbeat comes every
/// 100 ms, encoder estimates at least once a cycle.
struct OdriveParams : BusParams {
  double torque_constant_Nm_A = 0.05;  ///< of the motor, > 0
};

/// "" or the violated relation in words.
std::string check(const OdriveParams& params);

/// stop(kQuickStop) holds the last targets as kHold does: the protocol has no ramp of its own.
class OdriveBus final : public PhasedBus {
 public:
  OdriveBus(const OdriveParams& params, Transport& transport, FlightRecorder* recorder = nullptr);

  int num_axes() const override { return static_cast<int>(axes_.size()); }
  std::span<const ObjectIssue> issues() const override { return {}; }

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
    bool is_doubted = false;  ///< its state was told before a pause of ours
    odrive::InputPos command;
    odrive::InputPos offered;
  };

  bool is_cycling() const override;
  void take(const ReceivedFrame& received) override;
  void watch_cycle() override;
  void watch_time() override;
  void begin_phase() override;
  void advance_phase() override;
  void fill(std::span<AxisFeedback> feedback) const override;
  void send_cycle(const Targets& targets) override;
  void begin_stop(StopKind kind) override;
  bool offer_target(int index, const AxisTarget& target) override;
  void accept_offered() override;

  void configure_axes();
  void forget_axes();
  void advance_listening_to_axes();
  void advance_enabling();
  bool take(Axis& axis, int index, const CanFrame& frame);
  void request(odrive::AxisState state);
  bool all_heard() const;
  bool all_in(odrive::AxisState state) const;

  OdriveParams params_;
  std::vector<Axis> axes_;
  std::array<int, 64> axis_of_node_{};
  bool is_configured_ = false;
  std::int64_t cycle_us_ = 0;  ///< of the last cycle
};

}  // namespace can
