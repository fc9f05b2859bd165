// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/physics/head_thread.h"

#include <chrono>
#include <utility>

#include <sched.h>

#include "runtime/bus.h"
#include "runtime/channels.h"

namespace simulator {
namespace {

namespace channels = runtime::channels;

std::int64_t system_utime_us() {
  using std::chrono::system_clock;
  return std::chrono::duration_cast<std::chrono::microseconds>(
             system_clock::now().time_since_epoch())
      .count();
}

}  // namespace

HeadThread::HeadThread(BodyHeads heads, const std::string& url)
    : heads_(std::move(heads)), dead_(heads_.dead()) {
  runtime::Bus probe(url);  // throws here, not in the thread
  thread_ = std::thread([this, url] { run(url); });
}

HeadThread::~HeadThread() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void HeadThread::offer(std::int64_t now_us, const PhysicsModel& model,
                       const Eigen::Isometry3d& T_world_body) {
  {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock || is_busy_ || now_us < heads_.due_us()) return;
    for (int head = 0; head < kNumHeads; ++head) {
      heads_.set_dead(head, dead_[static_cast<std::size_t>(head)]);
    }
    heads_.skip_to(now_us);
    if (now_us < heads_.due_us()) return;
    heads_.look(model, T_world_body);
    utime_us_ = system_utime_us();
    is_busy_ = true;
  }
  wake_.notify_one();
}

void HeadThread::run(const std::string& url) {
  const sched_param ordinary{};  // physics may be real-time, this is not
  sched_setscheduler(0, SCHED_OTHER, &ordinary);
  runtime::Bus bus(url);
  std::unique_lock lock(mutex_);
  while (true) {
    wake_.wait(lock, [this] { return is_busy_ || is_ending_; });
    if (is_ending_) return;
    lock.unlock();
    if (const auto* frame = heads_.flash(utime_us_)) {
      bus.publish(channels::kTof[static_cast<std::size_t>(frame->head)], *frame);
    }
    if (const auto* truth = heads_.truth()) bus.publish(channels::kTruth, *truth);
    lock.lock();
    is_busy_ = false;
  }
}

}  // namespace simulator
