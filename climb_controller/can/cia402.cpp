// SPDX-License-Identifier: BSD-3-Clause
#include "can/cia402.h"

#include <algorithm>

#include "base/check.h"
#include "can/little_endian.h"

namespace can::cia402 {
namespace {

CanFrame frame_of(std::uint32_t id, std::uint8_t dlc) {
  CanFrame frame;
  frame.id = id;
  frame.dlc = dlc;
  return frame;
}

CanFrame node_frame(std::uint32_t function, std::uint8_t node, std::uint8_t dlc) {
  CHECK(node >= 1 && node <= 127, "CANopen nodes are 1..127");
  return frame_of(function + node, dlc);
}

bool is(const CanFrame& frame, FrameKind kind, std::uint8_t dlc) {
  return is_plain(frame) && frame.dlc == dlc && kind_of(frame.id) == kind;
}

bool is_known(NmtCommand command) {
  switch (command) {
    case NmtCommand::kStart:
    case NmtCommand::kStop:
    case NmtCommand::kEnterPreOperational:
    case NmtCommand::kResetNode:
    case NmtCommand::kResetCommunication:
      return true;
  }
  return false;
}

bool is_known(NmtState state) {
  switch (state) {
    case NmtState::kBootUp:
    case NmtState::kStopped:
    case NmtState::kOperational:
    case NmtState::kPreOperational:
      return true;
  }
  return false;
}

}  // namespace

FrameKind kind_of(std::uint32_t id) {
  if (id == 0x000) return FrameKind::kNmt;
  if (id == 0x080) return FrameKind::kSync;
  if (id > 0x7FF || node_of(id) == 0) return FrameKind::kOther;
  switch (id & 0x780) {
    case 0x080:
      return FrameKind::kEmergency;
    case 0x180:
      return FrameKind::kTpdo1;
    case 0x200:
      return FrameKind::kRpdo1;
    case 0x280:
      return FrameKind::kTpdo2;
    case 0x300:
      return FrameKind::kRpdo2;
    case 0x580:
      return FrameKind::kSdoResponse;
    case 0x600:
      return FrameKind::kSdoRequest;
    case 0x700:
      return FrameKind::kHeartbeat;
    default:
      return FrameKind::kOther;
  }
}

bool is_master_frame(const CanFrame& frame) {
  if (frame.error || frame.extended || frame.id > 0x7FF) return false;
  const std::uint32_t function = frame.id & 0x780;
  return frame.id == 0x000 || frame.id == 0x080 || function == 0x200 || function == 0x300 ||
         function == 0x600 || frame.id == 0x700U + kMasterNode;
}

CanFrame encode(const Nmt& nmt) {
  CanFrame frame = frame_of(0x000, 2);
  put(frame, 0, static_cast<std::uint8_t>(nmt.command));
  put(frame, 1, nmt.node);
  return frame;
}

std::optional<Nmt> decode_nmt(const CanFrame& frame) {
  if (!is(frame, FrameKind::kNmt, 2)) return std::nullopt;
  const Nmt nmt{static_cast<NmtCommand>(frame.data[0]), frame.data[1]};
  if (!is_known(nmt.command) || nmt.node > 127) return std::nullopt;
  return nmt;
}

CanFrame encode(const Heartbeat& heartbeat) {
  CanFrame frame = node_frame(0x700, heartbeat.node, 1);
  put(frame, 0, static_cast<std::uint8_t>(heartbeat.state));
  return frame;
}

std::optional<Heartbeat> decode_heartbeat(const CanFrame& frame) {
  if (!is(frame, FrameKind::kHeartbeat, 1)) return std::nullopt;
  const Heartbeat heartbeat{node_of(frame.id), static_cast<NmtState>(frame.data[0])};
  if (!is_known(heartbeat.state)) return std::nullopt;
  return heartbeat;
}

CanFrame encode_sync() {
  return frame_of(0x080, 0);
}

bool is_sync(const CanFrame& frame) {
  return is(frame, FrameKind::kSync, 0);
}

CanFrame encode(const Rpdo1& pdo) {
  CanFrame frame = node_frame(0x200, pdo.node, pdo.max_torque_permille ? 8 : 6);
  put(frame, 0, pdo.control_word);
  put(frame, 2, pdo.target_counts);
  if (pdo.max_torque_permille) put(frame, 6, *pdo.max_torque_permille);
  return frame;
}

std::optional<Rpdo1> decode_rpdo1(const CanFrame& frame) {
  const bool with_torque = is(frame, FrameKind::kRpdo1, 8);
  if (!with_torque && !is(frame, FrameKind::kRpdo1, 6)) return std::nullopt;
  Rpdo1 pdo;
  pdo.node = node_of(frame.id);
  pdo.control_word = get<std::uint16_t>(frame, 0);
  pdo.target_counts = get<std::int32_t>(frame, 2);
  if (with_torque) pdo.max_torque_permille = get<std::uint16_t>(frame, 6);
  return pdo;
}

CanFrame encode(const Rpdo2& pdo) {
  CanFrame frame = node_frame(0x300, pdo.node, 8);
  put(frame, 0, pdo.velocity_offset_counts_s);
  put(frame, 4, pdo.torque_offset_permille);
  put(frame, 6, pdo.mode);
  return frame;
}

std::optional<Rpdo2> decode_rpdo2(const CanFrame& frame) {
  if (!is(frame, FrameKind::kRpdo2, 8)) return std::nullopt;
  return Rpdo2{node_of(frame.id), get<std::int32_t>(frame, 0), get<std::int16_t>(frame, 4),
               get<std::int8_t>(frame, 6)};
}

CanFrame encode(const Tpdo1& pdo) {
  CanFrame frame = node_frame(0x180, pdo.node, pdo.torque_permille ? 8 : 6);
  put(frame, 0, pdo.status_word);
  put(frame, 2, pdo.position_counts);
  if (pdo.torque_permille) put(frame, 6, *pdo.torque_permille);
  return frame;
}

std::optional<Tpdo1> decode_tpdo1(const CanFrame& frame) {
  const bool with_torque = is(frame, FrameKind::kTpdo1, 8);
  if (!with_torque && !is(frame, FrameKind::kTpdo1, 6)) return std::nullopt;
  Tpdo1 pdo;
  pdo.node = node_of(frame.id);
  pdo.status_word = get<std::uint16_t>(frame, 0);
  pdo.position_counts = get<std::int32_t>(frame, 2);
  if (with_torque) pdo.torque_permille = get<std::int16_t>(frame, 6);
  return pdo;
}

CanFrame encode(const Tpdo2& pdo) {
  CanFrame frame = node_frame(0x280, pdo.node, 7);
  put(frame, 0, pdo.error_code);
  put(frame, 2, pdo.mode);
  put(frame, 3, pdo.digital_inputs);
  return frame;
}

std::optional<Tpdo2> decode_tpdo2(const CanFrame& frame) {
  if (!is(frame, FrameKind::kTpdo2, 7)) return std::nullopt;
  return Tpdo2{node_of(frame.id), get<std::uint16_t>(frame, 0), get<std::int8_t>(frame, 2),
               get<std::uint32_t>(frame, 3)};
}

CanFrame encode(const GripperTpdo& pdo) {
  CanFrame frame = node_frame(0x180, pdo.node, 6);
  put(frame, 0, pdo.touch_bits);
  put(frame, 2, pdo.force_dN[0]);
  put(frame, 4, pdo.force_dN[1]);
  return frame;
}

std::optional<GripperTpdo> decode_gripper_tpdo(const CanFrame& frame) {
  if (!is(frame, FrameKind::kTpdo1, 6)) return std::nullopt;
  return GripperTpdo{
      node_of(frame.id), frame.data[0], {get<std::int16_t>(frame, 2), get<std::int16_t>(frame, 4)}};
}

CanFrame encode(const Emergency& emergency) {
  CanFrame frame = node_frame(0x080, emergency.node, 8);
  put(frame, 0, emergency.error_code);
  put(frame, 2, emergency.error_register);
  std::copy(emergency.vendor.begin(), emergency.vendor.end(), frame.data.begin() + 3);
  return frame;
}

std::optional<Emergency> decode_emergency(const CanFrame& frame) {
  if (!is(frame, FrameKind::kEmergency, 8)) return std::nullopt;
  Emergency emergency;
  emergency.node = node_of(frame.id);
  emergency.error_code = get<std::uint16_t>(frame, 0);
  emergency.error_register = frame.data[2];
  std::copy(frame.data.begin() + 3, frame.data.end(), emergency.vendor.begin());
  return emergency;
}

bool is_warning_code(std::uint16_t error_code) {
  // Under-voltage of the mains or inside, excess temperature of the drive: it still works. The
  // neighbours (over-voltage, excess temperature of the device) come with the fault state.
  return error_code == 0x3120 || error_code == 0x3220 || error_code == 0x4310;
}

bool is_master_silent_code(std::uint16_t error_code) {
  return error_code == 0x8130 || error_code == 0x8250;
}

}  // namespace can::cia402
