// SPDX-License-Identifier: BSD-3-Clause
// One classic CAN frame as a plain struct: identifier and flags apart, where the kernel packs them
// into one word. What bytes mean is the codecs' business (cia402.h, odrive.h).
#pragma once

#include <array>
#include <cstdint>

namespace can {

inline constexpr int kMaxDataBytes = 8;

struct CanFrame {
  std::uint32_t id = 0;   ///< 11 bits; 29 when extended; the error class when error
  bool extended = false;  ///< 29-bit identifier (EFF)
  bool remote = false;    ///< remote request (RTR): a length, no bytes
  bool error = false;     ///< written by the controller's driver, never on the wire (ERR)
  bool fd = false;        ///< a CAN FD frame: seen only to be counted, its bytes are not kept
  std::uint8_t dlc = 0;   ///< number of bytes, 0..8
  std::array<std::uint8_t, kMaxDataBytes> data{};  ///< zero behind dlc

  friend bool operator==(const CanFrame&, const CanFrame&) = default;
};

/// A classic data frame with an 11-bit identifier: the only kind both servo protocols use.
inline bool is_plain(const CanFrame& frame) {
  return !frame.extended && !frame.remote && !frame.error && !frame.fd;
}

struct ReceivedFrame {
  CanFrame frame;
  std::int64_t receive_us = 0;  ///< kernel's receive time, us since the epoch; 0 = not known
  bool from_this_host = false;  ///< another socket of this host sent it (MSG_DONTROUTE)
};

}  // namespace can
