// SPDX-License-Identifier: BSD-3-Clause
// How one channel lies in the records of an IIO buffer: the kernel's type text
// "le:s12/16>>4" (Documentation/driver-api/iio/buffers) and the rules of alignment.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace sources {

struct IioType {
  bool is_big_endian = false;
  bool is_signed = false;
  int num_bits = 0;   ///< 1..64, what is left after the shift
  int num_bytes = 0;  ///< 1, 2, 4 or 8 in the record
  int shift = 0;      ///< to the right, before the sign
  bool operator==(const IioType&) const = default;
};

/// None when the text is no type, or one of repeated elements.
std::optional<IioType> parse_iio_type(std::string_view text);

/// The value in `bytes`, which has at least num_bytes elements.
std::int64_t decode_iio(const IioType& type, std::span<const std::uint8_t> bytes);

/// Where each of `types`, in the order of their scan indices, begins; returns the length of a
/// record. An element is aligned to its own size, a record to its largest element.
std::size_t lay_out_record(std::span<const IioType> types, std::span<std::size_t> offsets);

}  // namespace sources
