// SPDX-License-Identifier: BSD-3-Clause
// Integers in frames, low byte first, at a byte offset. Offsets are constants of the codecs.
#pragma once

#include <cstdint>
#include <type_traits>

#include "base/check.h"
#include "can/can_frame.h"

namespace can {

template <class Integer>
void put(CanFrame& frame, int offset, Integer value) {
  CHECK(offset >= 0 && offset + static_cast<int>(sizeof(Integer)) <= frame.dlc,
        "a field lies inside its frame");
  auto bits = static_cast<std::make_unsigned_t<Integer>>(value);
  for (std::size_t i = 0; i < sizeof(Integer); ++i) {
    frame.data[static_cast<std::size_t>(offset) + i] = static_cast<std::uint8_t>(bits);
    bits = static_cast<decltype(bits)>(static_cast<std::uint64_t>(bits) >> 8);
  }
}

template <class Integer>
Integer get(const CanFrame& frame, int offset) {
  CHECK(offset >= 0 && offset + static_cast<int>(sizeof(Integer)) <= kMaxDataBytes,
        "a field lies inside a frame");
  std::uint64_t bits = 0;
  for (std::size_t i = sizeof(Integer); i > 0; --i) {
    bits = bits << 8 | frame.data[static_cast<std::size_t>(offset) + i - 1];
  }
  return static_cast<Integer>(static_cast<std::make_unsigned_t<Integer>>(bits));
}

}  // namespace can
