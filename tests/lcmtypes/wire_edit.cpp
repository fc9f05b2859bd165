// SPDX-License-Identifier: BSD-3-Clause
#include "tests/lcmtypes/wire_edit.h"

#include <map>

#include "runtime/base/check.h"

namespace lcmtypes {
namespace {

const std::map<runtime::WireKind, int> kElementBytes{
    {runtime::WireKind::kBoolean, 1}, {runtime::WireKind::kByte, 1},
    {runtime::WireKind::kInt8, 1},    {runtime::WireKind::kInt16, 2},
    {runtime::WireKind::kInt32, 4},   {runtime::WireKind::kInt64, 8},
    {runtime::WireKind::kFloat, 4},   {runtime::WireKind::kDouble, 8},
    {runtime::WireKind::kString, 1},
};

std::int32_t read_int32(std::span<const std::uint8_t> message, std::size_t offset) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | message[offset + i];
  return static_cast<std::int32_t>(value);
}

}  // namespace

std::vector<Place> places(std::span<const std::uint8_t> message, const runtime::WireType& type) {
  std::vector<Place> result;
  std::size_t offset = 8;
  for (const runtime::WireField& field : type.fields) {
    Place place{&field, offset, field.fixed};
    if (field.count_index >= 0) {
      place.elements = read_int32(message, result[field.count_index].offset);
    }
    if (field.kind == runtime::WireKind::kString) {
      place.elements = read_int32(message, offset);
      offset += 4;
    }
    offset += static_cast<std::size_t>(place.elements * kElementBytes.at(field.kind));
    result.push_back(place);
  }
  CHECK(offset == message.size(), "the table and the encoded message disagree");
  return result;
}

Place place_of(std::span<const std::uint8_t> message, const runtime::WireType& type,
               std::string_view field) {
  for (const Place& place : places(message, type)) {
    if (place.field->name == field) return place;
  }
  CHECK(false, "no such field");
  return {};
}

void write_int32(std::vector<std::uint8_t>& message, std::size_t offset, std::int32_t value) {
  const auto bits = static_cast<std::uint32_t>(value);
  for (std::size_t i = 0; i < 4; ++i) {
    message[offset + i] = static_cast<std::uint8_t>(bits >> (24 - 8 * i));
  }
}

}  // namespace lcmtypes
