// SPDX-License-Identifier: BSD-3-Clause
// What goes into one control cycle and what comes out: plain values, no device, no message.
#pragma once

#include <cstdint>

#include <Eigen/Geometry>

#include "climb/failsafe.h"
#include "climb/grasp_choice.h"
#include "climb/limb_cycle.h"
#include "climb/odometry.h"
#include "climb/safety.h"
#include "climb/support.h"

namespace climb {

struct AxisReading {
  double position_rad = 0.0;
  double torque_Nm = 0.0;
  bool valid = false;  ///< heard in this cycle or the last two
};

struct ImuReading {
  Eigen::Quaterniond q_odom_body = Eigen::Quaterniond::Identity();
  double acceleration_m_s2 = 9.81;  ///< magnitude of what it feels
  bool valid = false;               ///< heard within 100 ms
};

enum class Order : std::uint8_t { kNone, kArm, kClimb, kClimbDown, kPause, kHold, kReset, kDisarm };

struct OperatorCommand {
  Order order = Order::kNone;
  std::uint64_t session_id = 0;  ///< must be this run's
  std::int64_t seq = 0;          ///< must rise
};

struct ControllerInput {
  std::int64_t now_us = 0;  ///< monotonic
  PerAxis<AxisReading> axes{};
  PerLeg<bool> touch{};
  bool estop_clear = false;  ///< the line says so; a lost line is not clear
  ImuReading imu;
  LadderView ladder;  ///< odom frame; its age_s is set here from the receipt
  std::int64_t ladder_received_us = -1'000'000'000;
  bool drives_ready = false;    ///< configured, no bus fault
  bool drives_enabled = false;  ///< follow targets
  FaultFlags faults = 0;        ///< found by bus, lines and service
  OperatorCommand command;
};

/// What the drives are asked for beside targets.
enum class DriveRequest : std::uint8_t { kNone, kEnable, kHold, kQuickStop, kDisable };

enum class CommandVerdict : std::uint8_t { kNone, kAccepted, kWrongSession, kReplayed, kNotNow };

struct ControllerOutput {
  bool send = false;  ///< targets may go on the bus; they passed the gate
  PerAxis<AxisCommand> axes{};
  GateVerdict gate;
  DriveRequest drives = DriveRequest::kNone;
  ControllerState state = ControllerState::kBoot;
  Fault reason = Fault::kNone;  ///< of the last stop; kept while latched
  CommandVerdict command = CommandVerdict::kNone;
  PerLeg<LimbState> limbs{};
  PerLeg<int> rung_ids{};
  bool body_shift = false;
  bool at_top = false;
  bool at_dock = false;       ///< all claws where they held in the dock
  bool rests_safely = false;  ///< at the last HOLD: any one rung may break without a fall
  bool putting_down = false;  ///< FAULT_HOLD: a stance is lost, the limb in the air is put down
  bool fall_alarm = false;    ///< fewer than three claws hold, and none is being put down
  PerLeg<double> grip_N{};    ///< force of each loaded claw across its rung, by joint torques
  bool grip_alarm = false;    ///< one of them above grip_alarm_N; nothing else follows from it
  Refusal refusal = Refusal::kNone;  ///< why no grasp was chosen
  Burden burden = Burden::kBorne;    ///< why a limb may not be lifted
  OdometryEstimate pose;
};

}  // namespace climb
