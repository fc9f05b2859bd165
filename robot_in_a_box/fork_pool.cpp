// SPDX-License-Identifier: BSD-3-Clause
#include "robot_in_a_box/fork_pool.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <stdexcept>
#include <thread>
#include <utility>

#include <sys/wait.h>
#include <unistd.h>

#include "base/check.h"

namespace robot_in_a_box {
namespace {

std::string read_all(int descriptor) {
  std::string bytes;
  std::array<char, ForkPool::kMaxResult_bytes> buffer{};
  for (ssize_t num = 0; (num = read(descriptor, buffer.data(), buffer.size())) > 0;) {
    bytes.append(buffer.data(), static_cast<std::size_t>(num));
  }
  return bytes;
}

}  // namespace

ForkPool::ForkPool(int num_jobs)
    : num_jobs_(num_jobs > 0 ? static_cast<std::size_t>(num_jobs)
                             : std::max(1U, std::thread::hardware_concurrency())) {}

void ForkPool::run(const Work& work, Done done) {
  while (jobs_.size() >= num_jobs_) wait_for_one();
  std::fflush(nullptr);  // or the copy would print it again
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) throw std::runtime_error("no pipe for a copy of this process");
  const pid_t process = fork();
  if (process < 0) throw std::runtime_error("no copy of this process can be made");
  if (process == 0) {
    close(ends[0]);
    const std::string result = work();
    CHECK(result.size() <= kMaxResult_bytes, "a result fits the pipe");
    const ssize_t num = write(ends[1], result.data(), result.size());
    _exit(num == static_cast<ssize_t>(result.size()) ? 0 : 1);
  }
  close(ends[1]);
  jobs_.push_back({process, ends[0], std::move(done)});
}

void ForkPool::wait_for_one() {
  int status = 0;
  const pid_t ended = waitpid(-1, &status, 0);
  const auto job = std::find_if(jobs_.begin(), jobs_.end(),
                                [ended](const Job& each) { return each.process == ended; });
  CHECK(job != jobs_.end(), "only this pool makes copies");
  const std::string result = read_all(job->pipe);
  close(job->pipe);
  const Done done = std::move(job->done);
  jobs_.erase(job);
  done(WIFEXITED(status) && WEXITSTATUS(status) == 0, result);
}

void ForkPool::finish() {
  while (!jobs_.empty()) wait_for_one();
}

}  // namespace robot_in_a_box
