// SPDX-License-Identifier: BSD-3-Clause
// A program started by a test: output in a file, killed at the latest when the object goes.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace support {

class ChildProcess {
 public:
  /// Starts program with arguments and extra environment ("NAME=value"); standard output and error
  /// go to a file.
  ChildProcess(const std::string& program, const std::vector<std::string>& arguments,
               const std::vector<std::string>& environment = {});
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  bool running();
  void signal(int number);
  /// The exit status (128 + signal when killed), or nullopt when it still runs after the timeout.
  std::optional<int> wait(std::chrono::milliseconds timeout);
  /// What it printed so far.
  std::string output() const;
  /// The newest whole line that it printed.
  std::string last_line() const;
  /// Waits until its newest line has the words (wanted) or is without them; false after 5 s. What a
  /// program prints from time to time is older than the order just carried out: wait, do not look
  /// once.
  bool comes_to_show(const std::string& words, bool wanted = true) const;
  int pid() const { return pid_; }

 private:
  int pid_ = -1;
  std::optional<int> status_;
  std::string output_path_;
};

}  // namespace support
