// SPDX-License-Identifier: BSD-3-Clause
// Expedited SDO of cia402.h: command specifiers of CiA 301, 7.2.4.3.
#include <array>

#include "base/check.h"
#include "can/cia402.h"
#include "can/little_endian.h"

namespace can::cia402 {
namespace {

// The command byte: specifier in bits 7..5, unused bytes in 3..2, expedited in 1, size told in 0.
constexpr std::uint8_t kWriteRequest = 0x20;
constexpr std::uint8_t kReadRequest = 0x40;
constexpr std::uint8_t kWriteResponse = 0x60;
constexpr std::uint8_t kReadResponse = 0x40;
constexpr std::uint8_t kAbort = 0x80;
constexpr std::uint8_t kSpecifierBits = 0xE0;
constexpr std::uint8_t kExpedited = 0x02;
constexpr std::uint8_t kSizeTold = 0x01;

CanFrame sdo_frame(std::uint32_t function, std::uint8_t node, Object object, int command) {
  CHECK(node >= 1 && node <= 127, "CANopen nodes are 1..127");
  CanFrame frame;
  frame.id = function + node;
  frame.dlc = 8;
  put(frame, 0, static_cast<std::uint8_t>(command));
  put(frame, 1, object.index);
  put(frame, 3, object.subindex);
  return frame;
}

int with_size(std::uint8_t specifier, std::uint8_t num_bytes) {
  CHECK(num_bytes >= 1 && num_bytes <= 4, "expedited SDO carries 1..4 bytes");
  return specifier | kExpedited | kSizeTold | (4 - num_bytes) << 2;
}

std::uint8_t size_of(std::uint8_t command) {
  return (command & kSizeTold) != 0 ? static_cast<std::uint8_t>(4 - (command >> 2 & 3))
                                    : std::uint8_t{4};
}

std::uint32_t low_bytes(std::uint32_t value, std::uint8_t num_bytes) {
  return num_bytes >= 4 ? value : value & ((1U << 8 * num_bytes) - 1U);
}

bool is_sdo(const CanFrame& frame, FrameKind kind) {
  return is_plain(frame) && frame.dlc == 8 && kind_of(frame.id) == kind;
}

Object object_of(const CanFrame& frame) {
  return {get<std::uint16_t>(frame, 1), frame.data[3]};
}

}  // namespace

CanFrame encode(const SdoRequest& request) {
  const int command = request.write ? with_size(kWriteRequest, request.num_bytes) : kReadRequest;
  CanFrame frame = sdo_frame(0x600, request.node, request.object, command);
  if (request.write) put(frame, 4, low_bytes(request.value, request.num_bytes));
  return frame;
}

std::optional<SdoRequest> decode_sdo_request(const CanFrame& frame) {
  if (!is_sdo(frame, FrameKind::kSdoRequest)) return std::nullopt;
  const std::uint8_t command = frame.data[0];
  SdoRequest request;
  request.node = node_of(frame.id);
  request.object = object_of(frame);
  if ((command & kSpecifierBits) == kReadRequest) return request;
  if ((command & kSpecifierBits) != kWriteRequest || (command & kExpedited) == 0) {
    return std::nullopt;
  }
  request.write = true;
  request.num_bytes = size_of(command);
  request.value = low_bytes(get<std::uint32_t>(frame, 4), request.num_bytes);
  return request;
}

CanFrame encode(const SdoResponse& response) {
  switch (response.kind) {
    case SdoResponse::Kind::kWritten:
      return sdo_frame(0x580, response.node, response.object, kWriteResponse);
    case SdoResponse::Kind::kAbort: {
      CanFrame frame = sdo_frame(0x580, response.node, response.object, kAbort);
      put(frame, 4, response.value);
      return frame;
    }
    case SdoResponse::Kind::kValue:
      break;
  }
  CanFrame frame = sdo_frame(0x580, response.node, response.object,
                             with_size(kReadResponse, response.num_bytes));
  put(frame, 4, low_bytes(response.value, response.num_bytes));
  return frame;
}

std::optional<SdoResponse> decode_sdo_response(const CanFrame& frame) {
  if (!is_sdo(frame, FrameKind::kSdoResponse)) return std::nullopt;
  const std::uint8_t command = frame.data[0];
  SdoResponse response;
  response.node = node_of(frame.id);
  response.object = object_of(frame);
  switch (command & kSpecifierBits) {
    case kWriteResponse:
      response.kind = SdoResponse::Kind::kWritten;
      return response;
    case kAbort:
      response.kind = SdoResponse::Kind::kAbort;
      response.value = get<std::uint32_t>(frame, 4);
      return response;
    case kReadResponse:
      if ((command & kExpedited) == 0) return std::nullopt;
      response.kind = SdoResponse::Kind::kValue;
      response.num_bytes = size_of(command);
      response.value = low_bytes(get<std::uint32_t>(frame, 4), response.num_bytes);
      return response;
    default:
      return std::nullopt;
  }
}

CanFrame encode_sdo_abort(std::uint8_t node, Object object, std::uint32_t abort_code) {
  CanFrame frame = sdo_frame(0x600, node, object, kAbort);
  put(frame, 4, abort_code);
  return frame;
}

const char* abort_text(std::uint32_t abort_code) {
  struct Row {
    std::uint32_t code;
    const char* text;
  };
  // CiA 301, table 22.
  static constexpr std::array<Row, 26> kRows = {{
      {0x05030000, "toggle bit not alternated"},
      {0x05040000, "SDO protocol timed out"},
      {0x05040001, "command specifier not valid"},
      {0x05040005, "out of memory"},
      {0x06010000, "unsupported access"},
      {0x06010001, "write-only object"},
      {0x06010002, "read-only object"},
      {0x06020000, "object does not exist"},
      {0x06040041, "object cannot be mapped to the PDO"},
      {0x06040042, "mapping exceeds the PDO's length"},
      {0x06040043, "parameter incompatible"},
      {0x06040047, "internal incompatibility"},
      {0x06060000, "hardware error"},
      {0x06070010, "length of parameter does not match"},
      {0x06070012, "parameter too long"},
      {0x06070013, "parameter too short"},
      {0x06090011, "subindex does not exist"},
      {0x06090030, "value range exceeded"},
      {0x06090031, "value too high"},
      {0x06090032, "value too low"},
      {0x06090036, "maximum less than minimum"},
      {0x060A0023, "resource not available"},
      {0x08000000, "general error"},
      {0x08000020, "cannot be stored"},
      {0x08000021, "local control"},
      {0x08000022, "not in this device state"},
  }};
  for (const Row& row : kRows) {
    if (row.code == abort_code) return row.text;
  }
  return "unknown abort code";
}

}  // namespace can::cia402
