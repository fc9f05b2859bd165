// SPDX-License-Identifier: BSD-3-Clause
// Every frame of the CANopen wire contract (CiA 301 and 402), little-endian, as a struct with
// encode and decode. Pure: no socket, no time, no state. Decoders answer nothing (nullopt) to a
// frame of another kind, a wrong length, RTR, 29 bits or FD; they never read behind dlc.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "can/can_frame.h"

namespace can::cia402 {

inline constexpr std::uint8_t kMasterNode = 0x7F;
inline constexpr std::uint8_t kAllNodes = 0;

/// What an 11-bit identifier announces (CiA 301 predefined connection set).
enum class FrameKind : std::uint8_t {
  kNmt,          ///< 000h
  kSync,         ///< 080h
  kEmergency,    ///< 080h + node
  kTpdo1,        ///< 180h + node
  kRpdo1,        ///< 200h + node
  kTpdo2,        ///< 280h + node
  kRpdo2,        ///< 300h + node
  kSdoResponse,  ///< 580h + node
  kSdoRequest,   ///< 600h + node
  kHeartbeat,    ///< 700h + node
  kOther,
};

FrameKind kind_of(std::uint32_t id);
inline std::uint8_t node_of(std::uint32_t id) {
  return static_cast<std::uint8_t>(id & 0x7F);
}

/// Frames that only a master sends: 000h, 080h, 200h-27Fh, 300h-37Fh, 600h-67Fh, 77Fh.
bool is_master_frame(const CanFrame& frame);

// --- network management -------------------------------------------------------------------------

enum class NmtCommand : std::uint8_t {
  kStart = 0x01,
  kStop = 0x02,
  kEnterPreOperational = 0x80,
  kResetNode = 0x81,
  kResetCommunication = 0x82,
};
struct Nmt {
  NmtCommand command{};
  std::uint8_t node = kAllNodes;
};

enum class NmtState : std::uint8_t {
  kBootUp = 0x00,
  kStopped = 0x04,
  kOperational = 0x05,
  kPreOperational = 0x7F,
};
struct Heartbeat {
  std::uint8_t node = 0;
  NmtState state{};
};

CanFrame encode(const Nmt& nmt);
CanFrame encode(const Heartbeat& heartbeat);
CanFrame encode_sync();
std::optional<Nmt> decode_nmt(const CanFrame& frame);
std::optional<Heartbeat> decode_heartbeat(const CanFrame& frame);
bool is_sync(const CanFrame& frame);

// --- process data -------------------------------------------------------------------------------

/// 200h + node: 6040h u16, 607Ah i32, 6072h u16 (left out by drives without it: 6 bytes).
struct Rpdo1 {
  std::uint8_t node = 0;
  std::uint16_t control_word = 0;
  std::int32_t target_counts = 0;
  std::optional<std::uint16_t> max_torque_permille;
};
/// 300h + node: 60B1h i32, 60B2h i16, 6060h i8, one byte of padding.
struct Rpdo2 {
  std::uint8_t node = 0;
  std::int32_t velocity_offset_counts_s = 0;
  std::int16_t torque_offset_permille = 0;
  std::int8_t mode = 0;
};
/// 180h + node: 6041h u16, 6064h i32, 6077h i16 (left out by drives without it: 6 bytes).
struct Tpdo1 {
  std::uint8_t node = 0;
  std::uint16_t status_word = 0;
  std::int32_t position_counts = 0;
  std::optional<std::int16_t> torque_permille;
};
/// 280h + node: 603Fh u16, 6061h i8, 60FDh u32.
struct Tpdo2 {
  std::uint8_t node = 0;
  std::uint16_t error_code = 0;
  std::int8_t mode = 0;
  std::uint32_t digital_inputs = 0;
};
/// 1A1h-1A4h: 6000h:1 touch bits, padding, two forces in 0.1 N.
struct GripperTpdo {
  std::uint8_t node = 0;
  std::uint8_t touch_bits = 0;
  std::array<std::int16_t, 2> force_dN{};
};
/// 080h + node; error_code 0 = all errors gone.
struct Emergency {
  std::uint8_t node = 0;
  std::uint16_t error_code = 0;
  std::uint8_t error_register = 0;
  std::array<std::uint8_t, 5> vendor{};
};

CanFrame encode(const Rpdo1& pdo);
CanFrame encode(const Rpdo2& pdo);
CanFrame encode(const Tpdo1& pdo);
CanFrame encode(const Tpdo2& pdo);
CanFrame encode(const GripperTpdo& pdo);
CanFrame encode(const Emergency& emergency);
std::optional<Rpdo1> decode_rpdo1(const CanFrame& frame);
std::optional<Rpdo2> decode_rpdo2(const CanFrame& frame);
std::optional<Tpdo1> decode_tpdo1(const CanFrame& frame);
std::optional<Tpdo2> decode_tpdo2(const CanFrame& frame);
std::optional<GripperTpdo> decode_gripper_tpdo(const CanFrame& frame);
std::optional<Emergency> decode_emergency(const CanFrame& frame);

/// Supply voltage (31xxh-33xxh) or temperature (41xxh-43xxh): a warning as long as the drive stays
/// in operation.
bool is_warning_code(std::uint16_t error_code);

/// The master's heartbeat (8130h) or its targets (8250h) did not come.
bool is_master_silent_code(std::uint16_t error_code);

// --- service data, expedited only ---------------------------------------------------------------

struct Object {
  std::uint16_t index = 0;
  std::uint8_t subindex = 0;
  friend bool operator==(const Object&, const Object&) = default;
};

struct SdoRequest {
  std::uint8_t node = 0;
  Object object;
  bool write = false;
  std::uint8_t num_bytes = 4;  ///< of a write, 1..4
  std::uint32_t value = 0;     ///< of a write; above num_bytes zero
};
struct SdoResponse {
  enum class Kind : std::uint8_t { kWritten, kValue, kAbort };
  std::uint8_t node = 0;
  Object object;
  Kind kind{};
  std::uint8_t num_bytes = 4;  ///< of kValue; 4 when the drive does not say
  std::uint32_t value = 0;     ///< of kValue; of kAbort the abort code
};

CanFrame encode(const SdoRequest& request);
CanFrame encode(const SdoResponse& response);
CanFrame encode_sdo_abort(std::uint8_t node, Object object, std::uint32_t abort_code);
std::optional<SdoRequest> decode_sdo_request(const CanFrame& frame);
std::optional<SdoResponse> decode_sdo_response(const CanFrame& frame);

inline constexpr std::uint32_t kAbortTimeout = 0x05040000;
inline constexpr std::uint32_t kAbortAccess = 0x06010000;
inline constexpr std::uint32_t kAbortReadOnly = 0x06010002;
inline constexpr std::uint32_t kAbortNoObject = 0x06020000;
inline constexpr std::uint32_t kAbortNoSubindex = 0x06090011;
inline constexpr std::uint32_t kAbortDeviceState = 0x08000022;

/// "object does not exist" for 06020000h; "unknown abort code" for what CiA 301 does not list.
const char* abort_text(std::uint32_t abort_code);

}  // namespace can::cia402
