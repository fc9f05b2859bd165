// SPDX-License-Identifier: BSD-3-Clause
// One controller per servo bus on this host: a name in the abstract socket space, which the kernel
// takes back however the process ends.
#pragma once

#include <string>

namespace climb_controller {

class HostLock {
 public:
  /// Throws runtime::DeviceError when another process has it.
  explicit HostLock(const std::string& bus_name);
  ~HostLock();
  HostLock(const HostLock&) = delete;
  HostLock& operator=(const HostLock&) = delete;

 private:
  int fd_ = -1;
};

}  // namespace climb_controller
