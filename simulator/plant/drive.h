// SPDX-License-Identifier: BSD-3-Clause
// One servo drive on CANopen: a CiA 402 slave in cyclic synchronous position mode before a motor.
// NMT, heartbeat both ways, SDO, PDOs latched by SYNC, emergencies, power states, quick stop, the
// reaction to a lost master (6007h), following error, soft limits. No clock: receive() and
// advance() are told the time; timers and motor run on a grid of kStep_us.
// Written from the standards' tables and the wire contract alone, not from the controller.
// Does not model: other modes, homing, segmented SDO, non-volatile parameters, SYNC-loss alarms.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "simulator/plant/bus_frame.h"
#include "simulator/plant/motor.h"
#include "simulator/plant/object_dictionary.h"
#include "simulator/plant/pdo.h"
#include "simulator/plant/power_state.h"

namespace simulator {

struct DriveParams {
  std::uint8_t node_id = 1;  ///< 1..126
  DriveObjects objects;
  MotorParams motor;
  double counts_per_rad = 10430.0;  ///< of the joint, gear included, > 0
  int sign = 1;                     ///< +1, or -1: counts grow against the joint's angle
  double offset_rad = 0.0;          ///< joint angle at 0 counts
  double rated_torque_Nm = 20.0;    ///< > 0, 1000 permille
  double start_rad = 0.0;
  bool brake_when_off = true;     ///< without torque a brake holds the joint
  std::int64_t boot_us = 20'000;  ///< from power-on or reset to the boot-up message, >= 0
};

/// "" or the violated relation.
std::string check(const DriveParams& params);

enum class NmtState : std::uint8_t { kBooting, kPreOperational, kOperational, kStopped };

/// Broken on purpose; see also Motor.
struct DriveFaults {
  bool silent = false;              ///< neither hears nor sends
  bool no_heartbeat = false;        ///< but PDOs go on
  bool wrong_length = false;        ///< TPDO1 one byte short
  bool no_state = false;            ///< TPDO1 missing, the rest goes on
  double encoder_offset_rad = 0.0;  ///< the position told is off by so much
};

class Drive {
 public:
  static constexpr std::int64_t kStep_us = 1000;

  explicit Drive(const DriveParams& params);

  /// A frame from the bus; answers are appended to `sent`.
  void receive(const BusFrame& frame, std::int64_t now_us, std::vector<BusFrame>& sent);
  /// Every step of the grid up to and including now.
  void advance(std::int64_t now_us, std::vector<BusFrame>& sent);

  std::uint8_t node_id() const { return params_.node_id; }
  PowerState power_state() const { return power_; }
  NmtState nmt_state() const { return nmt_; }
  /// Held by torque or brake.
  bool holds_position() const { return has_torque(power_) || params_.brake_when_off; }
  /// Where the joint is, deflection under load included.
  double measured_rad() const { return motor_.position_rad() + deflection_rad_; }
  /// Angle that the drive makes for just now.
  double demand_rad() const;
  double torque_limit_Nm() const;
  std::uint16_t error_code() const;
  const DriveParams& params() const { return params_; }
  const ObjectDictionary& objects() const { return dictionary_; }

  Motor& motor() { return motor_; }
  const Motor& motor() const { return motor_; }
  void set_deflection(double deflection_rad) { deflection_rad_ = deflection_rad; }
  void set_digital_inputs(std::uint32_t bits);

  DriveFaults faults;
  void raise_fault(std::uint16_t code, std::vector<BusFrame>& sent);
  /// An emergency without a change of state: under-voltage, temperature.
  void raise_warning(std::uint16_t code, std::vector<BusFrame>& sent);
  void clear_warning(std::vector<BusFrame>& sent);
  void reboot(std::int64_t now_us);
  void drop_to_pre_operational(std::vector<BusFrame>& sent);
  /// Power to the motor cut by hardware (safe torque off); stays off until given back.
  void set_torque_permitted(bool permitted);

  std::int32_t counts(double angle_rad) const;
  double angle_rad(double position_counts) const;

 private:
  // drive_network.cpp
  void on_nmt(const BusFrame& frame, std::int64_t now_us, std::vector<BusFrame>& sent);
  void on_sync(const BusFrame& frame, std::int64_t now_us, std::vector<BusFrame>& sent);
  void on_heartbeat(const BusFrame& frame, std::int64_t now_us, std::vector<BusFrame>& sent);
  void on_sdo(const BusFrame& frame, std::int64_t now_us, std::vector<BusFrame>& sent);
  void on_rpdo(std::size_t number, const BusFrame& frame, std::int64_t now_us,
               std::vector<BusFrame>& sent);
  void enter_nmt(NmtState next, std::vector<BusFrame>& sent);
  void reset_node(bool communication_only, std::int64_t now_us);
  void boot(std::int64_t now_us, std::vector<BusFrame>& sent);
  void watch_master(std::int64_t now_us, std::vector<BusFrame>& sent);
  void send_timed(std::int64_t now_us, std::vector<BusFrame>& sent);
  void send_tpdo(std::size_t number, std::int64_t now_us, std::vector<BusFrame>& sent);
  void send_emergency(std::uint16_t code, std::vector<BusFrame>& sent);
  void lose_connection(std::vector<BusFrame>& sent);
  void configure_pdos();
  // drive.cpp
  void step(std::int64_t now_us, std::vector<BusFrame>& sent);
  void apply_control_word(std::vector<BusFrame>& sent);
  void apply_target(std::int64_t now_us);
  void enter(PowerState next);
  void quick_stop();
  void start_fault_reaction();
  void move_motor(std::int64_t now_us);
  void finish_ramps();
  void watch_following_error(std::vector<BusFrame>& sent);
  void refresh_objects();
  std::uint16_t status_word() const;

  DriveParams params_;
  ObjectDictionary dictionary_;
  Motor motor_;
  double deflection_rad_ = 0.0;
  NmtState nmt_ = NmtState::kBooting;
  PowerState power_ = PowerState::kSwitchOnDisabled;
  std::int64_t next_step_us_ = 0;
  std::int64_t boot_due_us_ = 0;
  std::uint16_t last_control_word_ = 0;
  bool warning_ = false;
  bool torque_permitted_ = true;
  bool limit_active_ = false;
  bool following_error_ = false;
  std::int64_t following_error_us_ = 0;
  // Interpolation of 60C2h: demand moves from `from` to `to` in counts.
  double demand_from_ = 0.0;
  double demand_to_ = 0.0;
  std::int64_t demand_start_us_ = 0;
  std::int64_t demand_period_us_ = 0;
  double demand_ = 0.0;
  // Network
  std::array<Pdo, 2> rpdos_ = {Pdo(0x1400), Pdo(0x1401)};
  std::array<Pdo, 2> tpdos_ = {Pdo(0x1800), Pdo(0x1801)};
  std::array<BusFrame, 2> staged_{};  ///< RPDOs waiting for SYNC
  std::array<bool, 2> is_staged_{};
  std::array<std::int64_t, 2> rpdo_heard_us_{};
  std::array<bool, 2> rpdo_watched_{};
  std::array<BusFrame, 2> tpdo_last_{};
  std::array<std::int64_t, 2> tpdo_sent_us_{};
  std::array<int, 2> syncs_{};
  std::int64_t heartbeat_due_us_ = 0;
  std::int64_t master_heard_us_ = 0;
  bool master_watched_ = false;
  bool master_lost_ = false;
};

}  // namespace simulator
