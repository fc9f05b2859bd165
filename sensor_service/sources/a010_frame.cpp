// SPDX-License-Identifier: BSD-3-Clause
#include "sources/a010_frame.h"

#include <algorithm>

namespace sources {
namespace {

constexpr std::uint8_t kFirst = 0x00, kSecond = 0xFF, kLast = 0xDD;

int little_endian(const std::uint8_t* bytes) {
  return bytes[0] | (bytes[1] << 8);
}

/// Whether the bytes that are there may be a packet's first ones.
bool may_begin(std::span<const std::uint8_t> bytes) {
  return bytes[0] == kFirst && (bytes.size() < 2 || bytes[1] == kSecond);
}

/// Whether the 20 bytes of a header belong together: only depth, square, a side that the unit has.
bool is_header(const std::uint8_t* bytes) {
  const int rows = bytes[14], columns = bytes[15];
  const bool is_known_size = rows == 100 || rows == 50 || rows == 25;
  return is_known_size && rows == columns && little_endian(bytes + 2) == 16 + rows * columns;
}

}  // namespace

bool A010Parser::next(A010Frame& frame) {
  drop_used();
  while (num_used_ < num_bytes_) {
    const std::uint8_t* packet = bytes_.data() + num_used_;
    const std::size_t num_waiting = num_bytes_ - num_used_;
    const bool has_header = num_waiting >= kHeaderBytes;
    if (!may_begin({packet, num_waiting}) || (has_header && !is_header(packet))) {
      ++num_used_;
      ++num_skipped_;
      continue;
    }
    if (!has_header) break;
    const std::size_t num_pixels = static_cast<std::size_t>(packet[14]) * packet[15];
    const std::size_t length = kHeaderBytes + num_pixels + 2;
    if (num_waiting < length) break;
    unsigned sum = 0;
    for (std::size_t i = 0; i < length - 2; ++i) sum += packet[i];
    if (packet[length - 2] != (sum & 0xFFU) || packet[length - 1] != kLast) {
      ++num_damaged_;
      ++num_used_;
      ++num_skipped_;
      continue;
    }
    frame = {.width_px = packet[15],
             .height_px = packet[14],
             .number = little_endian(packet + 16) & 0xFFF,
             .sensor_temperature = packet[6],
             .driver_temperature = packet[7],
             .counts = {packet + kHeaderBytes, num_pixels}};
    num_used_ += length;
    return true;
  }
  drop_used();
  return false;
}

/// Moves what is left to the front. What is left when a packet is awaited is shorter than the
/// longest packet, so there is always room for as much again.
void A010Parser::drop_used() {
  std::copy(bytes_.begin() + num_used_, bytes_.begin() + num_bytes_, bytes_.begin());
  num_bytes_ -= num_used_;
  num_used_ = 0;
}

std::int16_t a010_depth_mm(std::uint8_t count, int unit_mm) {
  if (count == 0 || count == 255) return 0;
  if (unit_mm > 0) return static_cast<std::int16_t>(count * unit_mm);
  return static_cast<std::int16_t>((count * count * 100 + 1300) / 2601);  // (count / 5.1)^2
}

}  // namespace sources
