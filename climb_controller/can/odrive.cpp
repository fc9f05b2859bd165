// SPDX-License-Identifier: BSD-3-Clause
#include "can/odrive.h"

#include <bit>
#include <cmath>

#include "base/check.h"
#include "can/little_endian.h"

namespace can::odrive {
namespace {

CanFrame frame_of(std::uint8_t node, Command command, std::uint8_t dlc) {
  CHECK(node <= kMaxNode, "CANSimple nodes are 0..63");
  CanFrame frame;
  frame.id = static_cast<std::uint32_t>(node) << 5 | static_cast<std::uint32_t>(command);
  frame.dlc = dlc;
  return frame;
}

bool is(const CanFrame& frame, Command command) {
  return command_of(frame) == command && frame.dlc == 8;
}

void put_float(CanFrame& frame, int offset, float value) {
  put(frame, offset, std::bit_cast<std::uint32_t>(value));
}

float get_float(const CanFrame& frame, int offset) {
  return std::bit_cast<float>(get<std::uint32_t>(frame, offset));
}

/// Most messages are two floats.
std::optional<CanFrame> two_floats(CanFrame frame, float first, float second) {
  if (!std::isfinite(first) || !std::isfinite(second)) return std::nullopt;
  put_float(frame, 0, first);
  put_float(frame, 4, second);
  return frame;
}

template <class Message>
std::optional<Message> decode_two_floats(const CanFrame& frame, Command command) {
  if (!is(frame, command)) return std::nullopt;
  const Message message{node_of(frame.id), get_float(frame, 0), get_float(frame, 4)};
  if (!std::isfinite(get_float(frame, 0)) || !std::isfinite(get_float(frame, 4))) {
    return std::nullopt;
  }
  return message;
}

}  // namespace

std::optional<Command> command_of(const CanFrame& frame) {
  if (!is_plain(frame) || frame.id > 0x7FF) return std::nullopt;
  const auto command = static_cast<Command>(frame.id & 0x1F);
  switch (command) {
    case Command::kHeartbeat:
    case Command::kEstop:
    case Command::kSetAxisState:
    case Command::kGetEncoderEstimates:
    case Command::kSetControllerMode:
    case Command::kSetInputPos:
    case Command::kSetLimits:
    case Command::kGetIq:
    case Command::kClearErrors:
      return command;
  }
  return std::nullopt;
}

bool is_master_frame(const CanFrame& frame) {
  const auto command = command_of(frame);
  return command && *command != Command::kHeartbeat && *command != Command::kGetEncoderEstimates &&
         *command != Command::kGetIq;
}

CanFrame encode(const Heartbeat& heartbeat) {
  CanFrame frame = frame_of(heartbeat.node, Command::kHeartbeat, 8);
  put(frame, 0, heartbeat.axis_error);
  put(frame, 4, heartbeat.axis_state);
  for (int i = 0; i < 3; ++i) put(frame, 5 + i, heartbeat.flags[i]);
  return frame;
}

std::optional<Heartbeat> decode_heartbeat(const CanFrame& frame) {
  if (!is(frame, Command::kHeartbeat)) return std::nullopt;
  return Heartbeat{node_of(frame.id),
                   get<std::uint32_t>(frame, 0),
                   frame.data[4],
                   {frame.data[5], frame.data[6], frame.data[7]}};
}

std::optional<CanFrame> encode(const EncoderEstimates& estimates) {
  return two_floats(frame_of(estimates.node, Command::kGetEncoderEstimates, 8),
                    estimates.position_rev, estimates.velocity_rev_s);
}

std::optional<EncoderEstimates> decode_encoder_estimates(const CanFrame& frame) {
  return decode_two_floats<EncoderEstimates>(frame, Command::kGetEncoderEstimates);
}

std::optional<CanFrame> encode(const Iq& iq) {
  return two_floats(frame_of(iq.node, Command::kGetIq, 8), iq.setpoint_A, iq.measured_A);
}

std::optional<Iq> decode_iq(const CanFrame& frame) {
  return decode_two_floats<Iq>(frame, Command::kGetIq);
}

std::optional<CanFrame> encode(const InputPos& input) {
  if (!std::isfinite(input.position_rev)) return std::nullopt;
  CanFrame frame = frame_of(input.node, Command::kSetInputPos, 8);
  put_float(frame, 0, input.position_rev);
  put(frame, 4, input.velocity_milli_rev_s);
  put(frame, 6, input.torque_mNm);
  return frame;
}

std::optional<InputPos> decode_input_pos(const CanFrame& frame) {
  if (!is(frame, Command::kSetInputPos) || !std::isfinite(get_float(frame, 0))) {
    return std::nullopt;
  }
  return InputPos{node_of(frame.id), get_float(frame, 0), get<std::int16_t>(frame, 4),
                  get<std::int16_t>(frame, 6)};
}

std::optional<CanFrame> encode(const Limits& limits) {
  return two_floats(frame_of(limits.node, Command::kSetLimits, 8), limits.velocity_rev_s,
                    limits.current_A);
}

std::optional<Limits> decode_limits(const CanFrame& frame) {
  return decode_two_floats<Limits>(frame, Command::kSetLimits);
}

CanFrame encode(const ControllerMode& mode) {
  CanFrame frame = frame_of(mode.node, Command::kSetControllerMode, 8);
  put(frame, 0, mode.control_mode);
  put(frame, 4, mode.input_mode);
  return frame;
}

std::optional<ControllerMode> decode_controller_mode(const CanFrame& frame) {
  if (!is(frame, Command::kSetControllerMode)) return std::nullopt;
  return ControllerMode{node_of(frame.id), get<std::uint32_t>(frame, 0),
                        get<std::uint32_t>(frame, 4)};
}

CanFrame encode(const SetAxisState& request) {
  CanFrame frame = frame_of(request.node, Command::kSetAxisState, 4);
  put(frame, 0, static_cast<std::uint32_t>(request.state));
  return frame;
}

std::optional<SetAxisState> decode_set_axis_state(const CanFrame& frame) {
  if (command_of(frame) != Command::kSetAxisState || frame.dlc != 4) return std::nullopt;
  return SetAxisState{node_of(frame.id), static_cast<AxisState>(get<std::uint32_t>(frame, 0))};
}

CanFrame encode_estop(std::uint8_t node) {
  return frame_of(node, Command::kEstop, 0);
}

CanFrame encode_clear_errors(std::uint8_t node) {
  return frame_of(node, Command::kClearErrors, 0);
}

}  // namespace can::odrive
