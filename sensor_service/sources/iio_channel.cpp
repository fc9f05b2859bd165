// SPDX-License-Identifier: BSD-3-Clause
#include "sources/iio_channel.h"

#include <algorithm>
#include <charconv>

#include "base/check.h"

namespace sources {
namespace {

/// Takes `expected` off the front; false when it is not there.
bool skip(std::string_view& text, std::string_view expected) {
  if (!text.starts_with(expected)) return false;
  text.remove_prefix(expected.size());
  return true;
}

/// Takes a number off the front.
bool read(std::string_view& text, int& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc()) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return true;
}

std::size_t rounded_up(std::size_t value, std::size_t step) {
  return (value + step - 1) / step * step;
}

}  // namespace

std::optional<IioType> parse_iio_type(std::string_view text) {
  IioType type;
  if (skip(text, "be:")) {
    type.is_big_endian = true;
  } else if (!skip(text, "le:")) {
    return std::nullopt;
  }
  if (skip(text, "s")) {
    type.is_signed = true;
  } else if (!skip(text, "u")) {
    return std::nullopt;
  }
  int storage_bits = 0;
  if (!read(text, type.num_bits) || !skip(text, "/") || !read(text, storage_bits))
    return std::nullopt;
  if (!skip(text, ">>") || !read(text, type.shift)) return std::nullopt;
  if (!text.empty() && text != "\n") return std::nullopt;
  if (storage_bits != 8 && storage_bits != 16 && storage_bits != 32 && storage_bits != 64)
    return std::nullopt;
  if (type.num_bits < 1 || type.shift < 0 || type.num_bits + type.shift > storage_bits)
    return std::nullopt;
  type.num_bytes = storage_bits / 8;
  return type;
}

std::int64_t decode_iio(const IioType& type, std::span<const std::uint8_t> bytes) {
  const auto num_bytes = static_cast<std::size_t>(type.num_bytes);
  CHECK(bytes.size() >= num_bytes, "fewer bytes than the element has");
  std::uint64_t word = 0;
  for (std::size_t i = 0; i < num_bytes; ++i)
    word = (word << 8) | bytes[type.is_big_endian ? i : num_bytes - 1 - i];
  word >>= type.shift;
  const int unused_bits = 64 - type.num_bits;
  word <<= unused_bits;
  // C++20: shifting a negative number to the right keeps its sign.
  if (type.is_signed) return static_cast<std::int64_t>(word) >> unused_bits;
  return static_cast<std::int64_t>(word >> unused_bits);
}

std::size_t lay_out_record(std::span<const IioType> types, std::span<std::size_t> offsets) {
  CHECK(types.size() == offsets.size(), "one offset per type");
  std::size_t end = 0, largest = 1;
  for (std::size_t i = 0; i < types.size(); ++i) {
    const auto num_bytes = static_cast<std::size_t>(types[i].num_bytes);
    offsets[i] = rounded_up(end, num_bytes);
    end = offsets[i] + num_bytes;
    largest = std::max(largest, num_bytes);
  }
  return rounded_up(end, largest);
}

}  // namespace sources
