// SPDX-License-Identifier: BSD-3-Clause
// Between bytes from the network and messages. LCM's generated decode trusts the counts and string
// lengths it reads: one malformed message can abort the process, read out of bounds or allocate
// gigabytes. Here every message is walked first, with 64-bit arithmetic and without allocation, and
// only what is sound is decoded; then its values are checked (runtime/semantic_checks.h).
//
// Not here: whether a message is stale or repeated (Reject::kStale); that needs the stream and is
// the bus's business.
#pragma once

#include <cstdint>
#include <exception>
#include <span>
#include <string_view>

#include "ladder_msgs/encode_guard.hpp"
#include "ladder_msgs/wire_tables.hpp"
#include "runtime/reject.h"
#include "runtime/semantic_checks.h"
#include "runtime/wire_type.h"

namespace runtime {

/// Whether `message` is exactly one well-formed message of `type`: size within 8 .. max_bytes,
/// fingerprint, every count within 0 .. its limit and the rest of the message, every string within
/// its limit with one NUL at its end, nesting <= 16, no byte left over. O(size of its strings and
/// number of its fields).
Reject check_wire(std::span<const std::uint8_t> message, const WireType& type,
                  std::size_t max_bytes);

inline Reject check_wire(std::span<const std::uint8_t> message, const WireType& type) {
  return check_wire(message, type, type.max_bytes);
}

/// Fills `out` from `message`, or says why not; on a reject the content of `out` means nothing.
/// Reuses the memory `out` holds: keep one object per channel.
template <class Msg>
Reject decode_guarded(std::span<const std::uint8_t> message, Msg& out) noexcept {
  const Reject reject = check_wire(message, kWireTypeOf<Msg>);
  if (reject != Reject::kNone) return reject;
  const int size_bytes = static_cast<int>(message.size());
  try {
    if (out.decode(message.data(), 0, size_bytes) != size_bytes) return Reject::kSize;
    fit_arrays(out);
  } catch (const std::exception&) {
    return Reject::kSize;  // out of memory: the guard leaves decode no other reason to throw
  }
  return check_values(out);
}

}  // namespace runtime
