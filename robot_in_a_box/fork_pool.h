// SPDX-License-Identifier: BSD-3-Clause
// Runs work in forked copies of this process, several at a time: a copy starts from the robot as it
// is at this moment, so that a thousand futures of one past cost one past. Results come back
// through a pipe. For programs with one thread only.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace robot_in_a_box {

class ForkPool {
 public:
  /// Of the copy: bytes to hand back, at most kMaxResult_bytes.
  using Work = std::function<std::string()>;
  /// In this process, in the order in which copies end. `ended_well` is false after a crash.
  using Done = std::function<void(bool ended_well, const std::string& result)>;
  static constexpr std::size_t kMaxResult_bytes = 4096;

  /// `num_jobs` 0 = as many as there are processors.
  explicit ForkPool(int num_jobs);
  ~ForkPool() { finish(); }
  ForkPool(const ForkPool&) = delete;
  ForkPool& operator=(const ForkPool&) = delete;

  /// Waits while all jobs are busy. Throws std::runtime_error when no copy can be made.
  void run(const Work& work, Done done);
  void finish();

 private:
  struct Job {
    pid_t process = 0;
    int pipe = -1;
    Done done;
  };
  void wait_for_one();

  std::size_t num_jobs_;
  std::vector<Job> jobs_;
};

}  // namespace robot_in_a_box
