// SPDX-License-Identifier: BSD-3-Clause
// Frames of ODrive's CANSimple protocol, as its DBC for firmware 0.5.6 describes them; 0.6 differs
// in the heartbeat's last bytes. Identifier = node << 5 | command; little-endian. Positions in
// motor revolutions. Pure: no socket, no time, no state.
#pragma once

#include <cstdint>
#include <optional>

#include "can/can_frame.h"

namespace can::odrive {

inline constexpr int kMaxNode = 63;

enum class Command : std::uint8_t {
  kHeartbeat = 0x01,
  kEstop = 0x02,
  kSetAxisState = 0x07,
  kGetEncoderEstimates = 0x09,
  kSetControllerMode = 0x0B,
  kSetInputPos = 0x0C,
  kSetLimits = 0x0F,
  kGetIq = 0x14,
  kClearErrors = 0x18,
};

/// The command of a plain frame; none for a command that is not in the list above.
std::optional<Command> command_of(const CanFrame& frame);
inline std::uint8_t node_of(std::uint32_t id) {
  return static_cast<std::uint8_t>(id >> 5 & 0x3F);
}

/// Heartbeat.Axis_State and Set_Axis_State.Axis_Requested_State (others exist).
enum class AxisState : std::uint32_t { kUndefined = 0, kIdle = 1, kClosedLoopControl = 8 };

/// Motor -> master, every 100 ms by default. Bytes 5..7 differ between generations and are kept.
struct Heartbeat {
  std::uint8_t node = 0;
  std::uint32_t axis_error = 0;
  std::uint8_t axis_state = 0;
  std::uint8_t flags[3] = {0, 0, 0};
};
/// Motor -> master: revolutions and revolutions per second of the motor.
struct EncoderEstimates {
  std::uint8_t node = 0;
  float position_rev = 0;
  float velocity_rev_s = 0;
};
/// Motor -> master: quadrature current.
struct Iq {
  std::uint8_t node = 0;
  float setpoint_A = 0;
  float measured_A = 0;
};
/// Master -> motor: feed-forward in steps of 0.001 rev/s and 0.001 Nm.
struct InputPos {
  std::uint8_t node = 0;
  float position_rev = 0;
  std::int16_t velocity_milli_rev_s = 0;
  std::int16_t torque_mNm = 0;
};
struct Limits {
  std::uint8_t node = 0;
  float velocity_rev_s = 0;
  float current_A = 0;
};
struct ControllerMode {
  std::uint8_t node = 0;
  std::uint32_t control_mode = 3;  ///< position
  std::uint32_t input_mode = 1;    ///< pass through
};
struct SetAxisState {
  std::uint8_t node = 0;
  AxisState state = AxisState::kIdle;
};

/// Frames with a float that is not finite are never made (nullopt) and never accepted.
CanFrame encode(const Heartbeat& heartbeat);
std::optional<CanFrame> encode(const EncoderEstimates& estimates);
std::optional<CanFrame> encode(const Iq& iq);
std::optional<CanFrame> encode(const InputPos& input);
std::optional<CanFrame> encode(const Limits& limits);
CanFrame encode(const ControllerMode& mode);
CanFrame encode(const SetAxisState& request);
CanFrame encode_estop(std::uint8_t node);  ///< disarms: the limb goes limp
CanFrame encode_clear_errors(std::uint8_t node);

std::optional<Heartbeat> decode_heartbeat(const CanFrame& frame);
std::optional<EncoderEstimates> decode_encoder_estimates(const CanFrame& frame);
std::optional<Iq> decode_iq(const CanFrame& frame);
std::optional<InputPos> decode_input_pos(const CanFrame& frame);
std::optional<Limits> decode_limits(const CanFrame& frame);
std::optional<ControllerMode> decode_controller_mode(const CanFrame& frame);
std::optional<SetAxisState> decode_set_axis_state(const CanFrame& frame);

/// A frame that only a master sends.
bool is_master_frame(const CanFrame& frame);

}  // namespace can::odrive
