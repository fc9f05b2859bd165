// SPDX-License-Identifier: BSD-3-Clause
// Images of a MaixSense A010 out of its byte stream, by Sipeed's description of it
// (wiki.sipeed.com, maixsense-a010, "Image Packet Description" and its example program):
//
//   offset 0  0x00 0xFF          14  rows           all numbers little-endian
//          2  length = 16 + n    15  columns
//          4  reserved           16  frame number, counts to 4095
//          5  mode               18  version, reserved
//          6  sensor temp        20  n pixels, row by row from the upper left
//          7  driver temp      20+n  sum of all bytes before, modulo 256
//          8  exposure, 4      21+n  0xDD
//         12  error, reserved
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace sources {

/// One image; the pixels are the parser's.
struct A010Frame {
  int width_px = 0, height_px = 0;
  int number = 0;              ///< 0..4095, then again from 0
  int sensor_temperature = 0;  ///< as the unit reports it, unit not documented (degC by the looks)
  int driver_temperature = 0;
  std::span<const std::uint8_t> counts;
};

class A010Parser {
 public:
  static constexpr int kLargestSide_px = 100;

  /// Where the next bytes of the stream are to be put; never empty.
  std::span<std::uint8_t> room() { return std::span(bytes_).subspan(num_bytes_); }
  /// `num_bytes` of room() are filled.
  void fill(std::size_t num_bytes) { num_bytes_ += num_bytes; }

  /// The next whole image in the stream; false when more bytes are needed. A frame's pixels are
  /// valid until the next call. Whatever is no packet is passed over byte by byte, so that a
  /// packet behind garbage, or begun within a damaged one, is found.
  bool next(A010Frame& frame);

  /// A packet has begun to arrive.
  bool has_begun() const { return num_bytes_ > num_used_; }
  void reset() { num_bytes_ = num_used_ = 0; }

  std::int64_t num_damaged() const { return num_damaged_; }  ///< wrong sum or end
  std::int64_t num_skipped() const { return num_skipped_; }  ///< bytes that were no packet

 private:
  static constexpr std::size_t kHeaderBytes = 20;
  static constexpr std::size_t kLargestPacket =
      kHeaderBytes + kLargestSide_px * kLargestSide_px + 2;

  void drop_used();

  std::array<std::uint8_t, 2 * kLargestPacket> bytes_{};
  std::size_t num_bytes_ = 0;
  std::size_t num_used_ = 0;  ///< from the front: handed out or passed over
  std::int64_t num_damaged_ = 0;
  std::int64_t num_skipped_ = 0;
};

/// Millimetres of a count with this AT+UNIT: count x unit, or for unit 0 (count / 5.1)^2, rounded.
/// 0 (nothing) for 0 and for 255, which means "as far or farther".
std::int16_t a010_depth_mm(std::uint8_t count, int unit_mm);

}  // namespace sources
