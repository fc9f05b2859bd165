// SPDX-License-Identifier: BSD-3-Clause
// The wire layout of a message type as a table. cmake/wire_tables.py writes one per .lcm file
// (ladder_msgs/wire_tables.hpp); runtime/wire_guard.cpp walks messages with it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace runtime {

enum class WireKind : std::uint8_t {
  kBoolean,
  kByte,
  kInt8,
  kInt16,
  kInt32,
  kInt64,
  kFloat,
  kDouble,
  kString,
  kNested,
};

struct WireType;

struct WireField {
  const char* name;
  WireKind kind;
  std::int32_t fixed;        ///< number of elements, unless count_index >= 0
  std::int32_t count_index;  ///< which field of this type holds the number of elements; -1 = fixed
  std::int32_t limit;        ///< highest value of a count, longest string [bytes]; -1 = neither
  const WireType* nested = nullptr;  ///< of kNested; our own messages are flat
};

struct WireType {
  const char* name;
  std::uint64_t fingerprint;  ///< what Msg::getHash() returns
  std::size_t max_bytes;      ///< the largest message within the limits, fingerprint included
  std::span<const WireField> fields;
};

/// kWireTypeOf<ladder_msgs::pose_t> is the table of pose_t (specialised in wire_tables.hpp).
template <class Msg>
inline constexpr WireType kWireTypeOf = Msg::has_no_wire_table;

}  // namespace runtime
