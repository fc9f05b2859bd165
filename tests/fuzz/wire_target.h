// SPDX-License-Identifier: BSD-3-Clause
// What must hold for any bytes: refused, or decoded so that they mean exactly one message.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "runtime/reject.h"

namespace fuzz {

/// The first byte selects the type, the rest is taken for a message of it. Its fingerprint is
/// repaired when the first byte is below 128: random bytes hardly ever hit one. Ends the process
/// when an accepted message does not encode again to the same bytes, or is not encodable.
runtime::Reject check_bytes(std::span<const std::uint8_t> input);

/// An input that is accepted, of the type with this index.
std::vector<std::uint8_t> sound_input(std::size_t type_index, int size, std::uint64_t seed);

}  // namespace fuzz
