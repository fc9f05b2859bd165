// SPDX-License-Identifier: BSD-3-Clause
// One file descriptor that is readable while any device of a source is: the work loop sleeps on it
// while devices come and go. Closing a device takes it out by itself.
#pragma once

namespace sources {

class ReadySet {
 public:
  ReadySet();
  ~ReadySet();
  ReadySet(const ReadySet&) = delete;
  ReadySet& operator=(const ReadySet&) = delete;

  void add(int fd);
  int file_descriptor() const { return fd_; }

 private:
  int fd_;
};

}  // namespace sources
