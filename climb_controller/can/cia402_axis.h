// SPDX-License-Identifier: BSD-3-Clause
// One CiA 402 drive as the master sees it: what it said last, whether that is alarming, and what
// to tell it in this cycle. Faults go to the line; phases belong to the bus (cia402_bus.h).
#pragma once

#include <cstdint>
#include <vector>

#include "can/bus_line.h"
#include "can/cia402_objects.h"
#include "can/cia402_states.h"
#include "can/sdo_client.h"

namespace can {

class Cia402Axis {
 public:
  Cia402Axis(int index, const AxisConfig& config, const Cia402Params& params);

  std::uint8_t node() const { return config_.node_id; }
  const AxisConfig& config() const { return config_; }
  DriveState state() const { return state_; }
  std::uint16_t status_word() const { return status_word_; }

  // --- configuration -----------------------------------------------------------------------------
  void begin_configuration(std::int64_t now_us);
  SdoClient& sdo() { return sdo_; }
  void finish_configuration();
  bool is_configured() const { return is_configured_; }
  /// Network state operational and a statusword heard since configuration began.
  bool is_running() const;

  // --- what the drive says. False: not a frame that this axis may send ---------------------------
  bool take(const CanFrame& frame, BusLine& line, std::int64_t now_us);

  /// Deadlines and states, once configured. `expects_frames`: a SYNC went out last cycle.
  void watch_cycle(BusLine& line, bool expects_frames);
  void watch_time(BusLine& line, const Cia402Params& params, std::int64_t now_us);
  void fill(AxisFeedback& feedback) const;

  /// Begins from what the drive says next: state, position as first target, deadlines from now.
  void forget(std::int64_t now_us);

  // --- what it is told ---------------------------------------------------------------------------
  void set_goal(cia402::Goal goal);
  void set_fault_reset(bool resetting) { is_resetting_ = resetting; }

  /// False: not finite or not representable. Nothing changes before accept_target().
  bool offer_target(const AxisTarget& target);
  void accept_target();

  /// After a pause of ours: it may have stopped by itself, and is told nothing before it speaks.
  void doubt() { is_doubted_ = true; }
  /// Nothing is told to a drive that has not said its state.
  bool may_send() const { return is_configured_ && has_status_ && !is_doubted_; }
  cia402::Rpdo1 next_rpdo1();
  cia402::Rpdo2 next_rpdo2() const;

 private:
  /// A target in the drive's units.
  struct Command {
    std::int32_t counts = 0;
    std::uint16_t max_torque_permille = 0;
    std::int32_t velocity_counts_s = 0;
    std::int16_t torque_permille = 0;
  };

  /// Else its PDOs are laid out as delivered, or as another master wished: they say nothing.
  bool knows_layout() const;
  bool take_tpdo1(const CanFrame& frame);
  bool take_tpdo2(const CanFrame& frame);
  void take_status(const cia402::Tpdo1& pdo);
  void take_emergency(const cia402::Emergency& emergency, BusLine& line);
  void take_heartbeat(cia402::NmtState state, BusLine& line, std::int64_t now_us);
  void raise(BusLine& line, FaultCause cause, std::uint32_t detail);
  void break_off(bool is_silent);
  /// What is seen holding by itself, and is to stay as it is, goes on holding by itself.
  void keep_stopped();

  AxisConfig config_;
  int index_;
  SdoClient sdo_;
  std::vector<ObjectStep> steps_;
  bool is_configured_ = false;
  bool is_under_configuration_ = false;

  std::int64_t heartbeat_us_ = 0;
  cia402::NmtState network_state_ = cia402::NmtState::kBootUp;
  bool has_status_ = false;  ///< statusword heard since forget()
  bool is_doubted_ = false;  ///< statusword older than our pause
  bool is_fresh_ = false;    ///< statusword heard since the last cycle
  bool was_fresh_ = false;   ///< the same for the feedback of this cycle
  int num_missed_ = 0;
  DriveState state_ = DriveState::kUnknown;
  std::uint16_t status_word_ = 0;
  std::int32_t position_counts_ = 0;
  std::int16_t torque_permille_ = 0;
  std::uint16_t error_code_ = 0;
  std::uint32_t digital_inputs_ = 0;

  cia402::Goal goal_ = cia402::Goal::kKeep;
  bool expects_torque_ = false;  ///< it was brought to hold: losing that is a fault
  bool may_quick_stop_ = false;  ///< it was told to, and was not enabled since
  bool is_broken_ = false;       ///< a fault of this axis: never enabled again before re-arming
  bool is_resetting_ = false;
  std::uint16_t control_word_ = 0;
  Command command_;
  Command offered_;
};

}  // namespace can
