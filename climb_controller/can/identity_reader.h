// SPDX-License-Identifier: BSD-3-Clause
// Asks a CiA 402 drive who it is and where it stands, before anything is written to it. Frames and
// time are handed in and out; what a drive does not tell stays empty.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "can/cia402.h"

namespace can {

struct DriveIdentity {
  bool answered = false;                       ///< at least one answer of any kind
  std::optional<std::uint32_t> device_type;    ///< 1000h, low 16 bits: profile
  std::optional<std::uint32_t> vendor;         ///< 1018h:1
  std::optional<std::uint32_t> product;        ///< 1018h:2
  std::optional<std::uint32_t> revision;       ///< 1018h:3
  std::optional<std::uint32_t> serial_number;  ///< 1018h:4
  std::optional<std::uint32_t> modes;          ///< 6502h, bit 7: cyclic synchronous position
  std::optional<std::uint32_t> status_word;    ///< 6041h
  std::optional<std::uint32_t> position;       ///< 6064h, counts as unsigned
};

class IdentityReader {
 public:
  explicit IdentityReader(std::uint8_t node) : node_(node) {}

  /// The frame to send now, if one is due.
  std::optional<CanFrame> next_frame(std::int64_t now_us);
  void take(const CanFrame& frame);
  bool is_done() const { return index_ >= kNumObjects; }
  const DriveIdentity& identity() const { return identity_; }

 private:
  static constexpr std::size_t kNumObjects = 8;

  std::uint8_t node_;
  DriveIdentity identity_;
  std::size_t index_ = 0;
  bool is_waiting_ = false;
  std::int64_t asked_us_ = 0;
};

}  // namespace can
