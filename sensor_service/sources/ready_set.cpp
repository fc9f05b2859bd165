// SPDX-License-Identifier: BSD-3-Clause
#include "sources/ready_set.h"

#include <sys/epoll.h>
#include <unistd.h>

#include "base/check.h"

namespace sources {

ReadySet::ReadySet() : fd_(epoll_create1(EPOLL_CLOEXEC)) {
  CHECK(fd_ >= 0, "epoll_create1 failed");
}

ReadySet::~ReadySet() {
  close(fd_);
}

void ReadySet::add(int fd) {
  epoll_event event{};
  event.events = EPOLLIN;
  event.data.fd = fd;
  // A file that cannot be waited for is looked at in every step all the same.
  epoll_ctl(fd_, EPOLL_CTL_ADD, fd, &event);
}

}  // namespace sources
