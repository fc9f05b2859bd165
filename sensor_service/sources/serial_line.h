// SPDX-License-Identifier: BSD-3-Clause
// A serial line for raw bytes: 8 data bits, no parity, no echo, never waits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace sources {

class SerialLine {
 public:
  SerialLine() = default;
  ~SerialLine();
  SerialLine(const SerialLine&) = delete;
  SerialLine& operator=(const SerialLine&) = delete;

  /// "" or what failed.
  std::string open(const std::string& path, int baud);
  void close();
  bool is_open() const { return fd_ >= 0; }
  int fd() const { return fd_; }

  /// Number of bytes that were there; the line closes itself when it is gone.
  std::size_t read(std::span<std::uint8_t> bytes);
  /// False when it did not take all of it.
  bool write(std::string_view text);

 private:
  int fd_ = -1;
};

/// Whether SerialLine knows this speed.
bool is_known_baud(int baud);

}  // namespace sources
