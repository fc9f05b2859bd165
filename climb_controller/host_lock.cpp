// SPDX-License-Identifier: BSD-3-Clause
#include "climb_controller/host_lock.h"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "runtime/service.h"

namespace climb_controller {

HostLock::HostLock(const std::string& bus_name) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  // A leading zero makes it abstract: no file. Long paths differ at their ends.
  const std::string name = "ladder_climb:" + bus_name;
  const std::size_t room = sizeof address.sun_path - 1;
  const std::string kept = name.size() > room ? name.substr(name.size() - room) : name;
  std::copy(kept.begin(), kept.end(), address.sun_path + 1);
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + kept.size());
  fd_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const auto* const where = static_cast<const sockaddr*>(static_cast<const void*>(&address));
  if (fd_ >= 0 && ::bind(fd_, where, size) == 0) return;
  const int error = errno;
  if (fd_ >= 0) ::close(fd_);
  if (error == EADDRINUSE) {
    throw runtime::DeviceError("another controller of this host has the servo bus " + bus_name +
                               "; stop it first: `ss -xap | grep ladder_climb` names it");
  }
  throw runtime::DeviceError("the servo bus " + bus_name +
                             " cannot be reserved: " + std::strerror(error));
}

HostLock::~HostLock() {
  ::close(fd_);
}

}  // namespace climb_controller
