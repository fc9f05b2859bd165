// SPDX-License-Identifier: BSD-3-Clause
// The system calls of a V4L2 camera, one to one, so that a test can answer instead of the kernel.
// Nothing is decided here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace sources {

class VideoCalls {
 public:
  virtual ~VideoCalls() = default;
  /// Paths of all video nodes of the machine.
  virtual std::vector<std::string> nodes() = 0;
  /// A file descriptor, or -errno.
  virtual int open(const std::string& path) = 0;
  virtual void close(int fd) = 0;
  /// ioctl(2); 0 or -errno.
  virtual int control(int fd, unsigned long request, void* argument) = 0;
  /// mmap(2), reading; nullptr when it fails.
  virtual void* map(int fd, std::size_t num_bytes, std::int64_t offset) = 0;
  virtual void unmap(void* address, std::size_t num_bytes) = 0;
  /// poll(2) without waiting: POLLERR, POLLHUP or POLLNVAL is set.
  virtual bool is_broken(int fd) = 0;
};

/// The kernel's.
class KernelVideoCalls final : public VideoCalls {
 public:
  std::vector<std::string> nodes() override;
  int open(const std::string& path) override;
  void close(int fd) override;
  int control(int fd, unsigned long request, void* argument) override;
  void* map(int fd, std::size_t num_bytes, std::int64_t offset) override;
  void unmap(void* address, std::size_t num_bytes) override;
  bool is_broken(int fd) override;
};

}  // namespace sources
