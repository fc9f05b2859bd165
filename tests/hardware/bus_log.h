// SPDX-License-Identifier: BSD-3-Clause
// candump beside a test, its log kept for decoders of others (bus_log_test.py).
#pragma once

#include <chrono>
#include <csignal>
#include <fstream>
#include <string>

#include "tests/support/child_process.h"

namespace hardware {

class BusLog {
 public:
  explicit BusLog(const std::string& interface) : candump_("/usr/bin/candump", {"-L", interface}) {}

  /// Ends it.
  void keep(const std::string& path) {
    candump_.signal(SIGTERM);
    candump_.wait(std::chrono::seconds(5));
    std::ofstream(path) << candump_.output();
  }

 private:
  support::ChildProcess candump_;
};

}  // namespace hardware
