// SPDX-License-Identifier: BSD-3-Clause
// The five lines where a machine has no GPIO: from the line hub of a simulated robot, a
// SOCK_SEQPACKET socket at a path. Each packet is {line, level}: line 0..3 touch FL FR RL RR,
// 4 E-stop, level 0 low, 1 high; all five come on connection, then every change. A hub that says
// anything else, or goes, is a lost chip.
#pragma once

#include <cstdint>
#include <string>

#include "gpio/line_chip.h"

namespace gpio {

class UnixLines : public LineChip {
 public:
  explicit UnixLines(std::string path);

  /// Takes over a connected SOCK_SEQPACKET (tests: socketpair). Cannot be opened again once lost.
  explicit UnixLines(int fd);

  ~UnixLines() override;
  UnixLines(const UnixLines&) = delete;
  UnixLines& operator=(const UnixLines&) = delete;

  std::string open() override;
  ReadStatus read(Levels& levels) override;
  int wake_fd() const override { return fd_; }
  std::string loss() const override;

 private:
  /// True while packets may follow.
  bool take_packet();
  void close();

  std::string path_;
  int fd_ = -1;
  Levels levels_{};
  std::uint8_t told_ = 0;  ///< one bit per line
  const char* loss_ = "";  ///< why fd_ is -1
};

}  // namespace gpio
