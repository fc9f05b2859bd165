// SPDX-License-Identifier: BSD-3-Clause
// One classic CAN frame as the plant sees it, and its little-endian numbers. The plant's own: it
// shares no encoding with the controller, so that a mistake of one is not hidden by the other.
#pragma once

#include <array>
#include <cstdint>

namespace simulator {

inline constexpr std::uint32_t kExtendedFlag = 0x80000000U;  ///< the kernel's bits above the id
inline constexpr std::uint32_t kRemoteFlag = 0x40000000U;
inline constexpr std::uint32_t kErrorFlag = 0x20000000U;
inline constexpr std::uint32_t kBusOffError = kErrorFlag | 0x40U;

struct BusFrame {
  std::uint32_t id = 0;  ///< 11 bits, plus the flags above
  std::uint8_t length = 0;
  std::array<std::uint8_t, 8> bytes{};

  bool operator==(const BusFrame&) const = default;
};

constexpr bool is_standard(const BusFrame& frame) {
  return frame.id <= 0x7FF && frame.length <= 8;
}

/// Unsigned little-endian number of 1..4 bytes at an offset.
constexpr std::uint32_t number_at(const BusFrame& frame, int offset, int num_bytes) {
  std::uint32_t value = 0;
  for (int i = num_bytes - 1; i >= 0; --i) {
    value = (value << 8) | frame.bytes[static_cast<std::size_t>(offset + i)];
  }
  return value;
}

constexpr void put_number(BusFrame& frame, int offset, int num_bytes, std::uint32_t value) {
  for (int i = 0; i < num_bytes; ++i) {
    frame.bytes[static_cast<std::size_t>(offset + i)] = static_cast<std::uint8_t>(value >> (8 * i));
  }
}

/// Two's complement of a number of 1..4 bytes.
constexpr std::int32_t signed_number(std::uint32_t value, int num_bytes) {
  if (num_bytes == 1) return static_cast<std::int8_t>(value);
  if (num_bytes == 2) return static_cast<std::int16_t>(value);
  return static_cast<std::int32_t>(value);
}

}  // namespace simulator
