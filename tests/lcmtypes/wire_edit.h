// SPDX-License-Identifier: BSD-3-Clause
// Where the fields of an encoded message lie, so that a test can damage exactly one of them.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "runtime/wire_type.h"

namespace lcmtypes {

struct Place {
  const runtime::WireField* field = nullptr;
  std::size_t offset = 0;     ///< of its first byte (of a string: of its length)
  std::int64_t elements = 0;  ///< of an array; length with NUL of a string
};

/// The places of all fields of a sound, flat message.
std::vector<Place> places(std::span<const std::uint8_t> message, const runtime::WireType& type);

Place place_of(std::span<const std::uint8_t> message, const runtime::WireType& type,
               std::string_view field);

void write_int32(std::vector<std::uint8_t>& message, std::size_t offset, std::int32_t value);

}  // namespace lcmtypes
