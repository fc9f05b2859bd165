// SPDX-License-Identifier: BSD-3-Clause
#include "sources/video_calls.h"

#include <cerrno>

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include "sources/sysfs.h"

namespace sources {

std::vector<std::string> KernelVideoCalls::nodes() {
  std::vector<std::string> paths;
  for (const std::string& name : names_in("/dev")) {
    if (name.starts_with("video")) paths.push_back("/dev/" + name);
  }
  return paths;
}

int KernelVideoCalls::open(const std::string& path) {
  const int fd = ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  return fd >= 0 ? fd : -errno;
}

void KernelVideoCalls::close(int fd) {
  ::close(fd);
}

int KernelVideoCalls::control(int fd, unsigned long request, void* argument) {
  int result = -1;
  do {
    result = ioctl(fd, request, argument);
  } while (result < 0 && errno == EINTR);
  return result < 0 ? -errno : 0;
}

void* KernelVideoCalls::map(int fd, std::size_t num_bytes, std::int64_t offset) {
  void* address = mmap(nullptr, num_bytes, PROT_READ, MAP_SHARED, fd, offset);
  return address == MAP_FAILED ? nullptr : address;
}

void KernelVideoCalls::unmap(void* address, std::size_t num_bytes) {
  munmap(address, num_bytes);
}

bool KernelVideoCalls::is_broken(int fd) {
  pollfd waiting{fd, POLLIN, 0};
  return poll(&waiting, 1, 0) > 0 && (waiting.revents & (POLLERR | POLLHUP | POLLNVAL)) != 0;
}

}  // namespace sources
