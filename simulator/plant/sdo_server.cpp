// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/plant/sdo_server.h"

#include "simulator/plant/pdo.h"

namespace simulator {
namespace {

// Command byte, bits 7..5 of a request.
constexpr int kDownload = 1;
constexpr int kUpload = 2;
constexpr int kAbortTransfer = 4;

/// Bytes of data that an expedited download announces; 0 = not expedited.
int announced_bytes(std::uint8_t command, int object_bytes) {
  const bool expedited = (command & 0x02) != 0;
  const bool size_told = (command & 0x01) != 0;
  if (!expedited) return 0;
  return size_told ? 4 - ((command >> 2) & 3) : object_bytes;
}

BusFrame response(std::uint8_t node_id, const BusFrame& request, std::uint8_t command,
                  std::uint32_t payload) {
  BusFrame frame;
  frame.id = 0x580U + node_id;
  frame.length = 8;
  frame.bytes[0] = command;
  for (std::size_t i = 1; i < 4; ++i) frame.bytes[i] = request.bytes[i];
  put_number(frame, 4, 4, payload);
  return frame;
}

}  // namespace

std::optional<BusFrame> answer_sdo(ObjectDictionary& dictionary, std::uint8_t node_id,
                                   const BusFrame& request) {
  if (request.length != 8) return std::nullopt;
  const std::uint8_t command = request.bytes[0];
  const int specifier = command >> 5;
  const auto index = static_cast<std::uint16_t>(number_at(request, 1, 2));
  const std::uint8_t subindex = request.bytes[3];
  const auto abort = [&](AbortCode code) { return response(node_id, request, 0x80, code); };

  if (specifier == kAbortTransfer) return std::nullopt;
  if (specifier != kDownload && specifier != kUpload) return abort(kUnknownCommand);
  const Object* object = dictionary.find(index, subindex);
  if (object == nullptr) return abort(dictionary.reason_missing(index));
  const int object_bytes = object->num_bytes();
  if (specifier == kUpload) {
    const auto answer = static_cast<std::uint8_t>(0x43 | ((4 - object_bytes) << 2));
    const std::uint32_t used = object_bytes == 4 ? ~0U : (1U << (8 * object_bytes)) - 1U;
    return response(node_id, request, answer, object->value & used);
  }
  const int num_bytes = announced_bytes(command, object_bytes);
  if (num_bytes == 0) return abort(kUnsupportedAccess);
  const std::uint32_t value = number_at(request, 4, num_bytes);
  if (const AbortCode code = check_pdo_write(dictionary, index, subindex, value);
      code != kNoAbort) {
    return abort(code);
  }
  if (const AbortCode code = dictionary.write(index, subindex, value, num_bytes);
      code != kNoAbort) {
    return abort(code);
  }
  return response(node_id, request, 0x60, 0);
}

}  // namespace simulator
