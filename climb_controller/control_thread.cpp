// SPDX-License-Identifier: BSD-3-Clause
#include "climb_controller/control_thread.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>

#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <sys/eventfd.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include "runtime/service.h"

namespace climb_controller {
namespace {

constexpr int kPriority = 80;
constexpr int kMessagePriority = 20;
constexpr std::int64_t kImuSilent_us = 100'000;
constexpr int kSettleSteps = 10;
constexpr int kSettleStep_us = 5'000;
constexpr int kMaxWakesPerCycle = 8;  // by edges of the lines: a chattering wire does not starve us

std::int64_t time_us(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return std::int64_t{1'000'000} * time.tv_sec + time.tv_nsec / 1000;
}

/// Locking is only asked for where it cannot make a later allocation fail.
std::string lock_memory() {
  rlimit limit{};
  getrlimit(RLIMIT_MEMLOCK, &limit);
  if (limit.rlim_cur != RLIM_INFINITY && geteuid() != 0) {
    return "memory not locked (LimitMEMLOCK=infinity permits it)";
  }
  if (mlockall(MCL_CURRENT | MCL_FUTURE) == 0) return "memory locked";
  return std::string("memory not locked (") + std::strerror(errno) + ")";
}

/// Every thread there is so far: the IMU comes through them, and its silence is a fault.
void raise_message_threads() {
  sched_param priority{};
  priority.sched_priority = kMessagePriority;
  for (const auto& thread : std::filesystem::directory_iterator("/proc/self/task")) {
    const pid_t id = std::atoi(thread.path().filename().c_str());
    static_cast<void>(sched_setscheduler(id, SCHED_FIFO, &priority));
  }
}

std::string take_priority(pthread_t thread) {
  sched_param priority{};
  priority.sched_priority = kPriority;
  const int error = pthread_setschedparam(thread, SCHED_FIFO, &priority);
  if (error == 0) return "SCHED_FIFO " + std::to_string(kPriority);
  return std::string("ordinary scheduling (SCHED_FIFO: ") + std::strerror(error) +
         "; LimitRTPRIO=80 permits it)";
}

}  // namespace

ControlThread::ControlThread(const ServiceParams& params)
    : params_(params),
      period_us_(
          static_cast<std::int64_t>(params.cycle.controller.climb.motion.period_s * 1e6 + 0.5)),
      socket_(can::CanSocketParams{.interface = params.can_interface}),
      bus_(make_servo_bus(params, socket_, &recorder_)),
      chip_(gpio::make_line_chip(params.lines)),
      lines_(params.lines, *chip_),
      cycle_(params.cycle, *bus_),
      clock_({.period_us = period_us_}) {
  news_fd_ = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  rungs_.prepare([](RungsSnapshot& snapshot) { snapshot.reserve(); });
}

ControlThread::~ControlThread() {
  stopping_ = true;
  if (thread_.joinable()) thread_.join();
  if (timer_fd_ >= 0) ::close(timer_fd_);
  if (news_fd_ >= 0) ::close(news_fd_);
}

void ControlThread::start() {
  lock_.emplace(params_.can_interface);
  if (const std::string problem = socket_.open(); !problem.empty()) {
    throw runtime::DeviceError("servo bus " + params_.can_interface + ": " + problem);
  }
  if (const std::string problem = lines_.open(); !problem.empty()) {
    throw runtime::DeviceError("lines " + params_.lines.chip + ": " + problem);
  }
  settle_lines();
  timer_fd_ = timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC | TFD_NONBLOCK);
  if (timer_fd_ < 0) throw runtime::DeviceError("no timer from the kernel");
  const std::string memory = lock_memory();
  raise_message_threads();
  thread_ = std::thread([this] { run(); });
  rights_ = take_priority(thread_.native_handle()) + ", " + memory;
}

/// Requesting a line may move its wire for a moment: an E-stop would be latched at the start.
void ControlThread::settle_lines() {
  for (int i = 0; i < kSettleSteps; ++i) {
    lines_.poll(time_us(CLOCK_MONOTONIC));
    usleep(kSettleStep_us);
  }
}

void ControlThread::forget_wake_up() {
  std::uint64_t count = 0;
  [[maybe_unused]] const ssize_t size = ::read(news_fd_, &count, sizeof count);
}

const can::FlightRecorder* ControlThread::flight() const {
  return flight_ready_.load(std::memory_order_acquire) ? &flight_ : nullptr;
}

void ControlThread::release_flight() {
  flight_ready_.store(false, std::memory_order_release);
}

void ControlThread::run() {
  std::int64_t deadline_us = time_us(CLOCK_MONOTONIC) + period_us_;
  while (!stopping_.load(std::memory_order_relaxed)) {
    wait_until(deadline_us);
    cycle(deadline_us);
    deadline_us += period_us_;
    // After a hold-up it goes on from now: cycles are not run after lost time.
    const std::int64_t now_us = time_us(CLOCK_MONOTONIC);
    if (now_us > deadline_us + period_us_) deadline_us = now_us;
  }
}

void ControlThread::wait_until(std::int64_t deadline_us) {
  itimerspec when{};
  when.it_value.tv_sec = deadline_us / 1'000'000;
  when.it_value.tv_nsec = deadline_us % 1'000'000 * 1000;
  timerfd_settime(timer_fd_, TFD_TIMER_ABSTIME, &when, nullptr);
  for (int wakes = 0;; ++wakes) {
    const int lines_fd = wakes < kMaxWakesPerCycle ? lines_.wake_fd() : -1;
    pollfd waiting[2] = {{timer_fd_, POLLIN, 0}, {lines_fd, POLLIN, 0}};
    ::poll(waiting, 2, -1);
    if ((waiting[0].revents & POLLIN) != 0) break;
    lines_.poll(time_us(CLOCK_MONOTONIC));  // an edge: its debounce begins now, not at the cycle
  }
  std::uint64_t expirations = 0;
  [[maybe_unused]] const ssize_t size = ::read(timer_fd_, &expirations, sizeof expirations);
}

void ControlThread::fill_inbox(std::int64_t now_us, CycleInbox& inbox) {
  const gpio::LineStates& lines = lines_.poll(now_us);
  for (const climb::Leg leg : climb::kLegs) inbox.lines.touch[leg] = lines.touch[leg];
  inbox.lines.estop_clear = !lines.estop_active;
  inbox.lines.lost = lines.lost;
  rungs_.refresh();
  inbox.ladder = rungs_.newest().view();
  inbox.ladder_received_us = rungs_.newest().received_us;
  imu_.refresh();
  inbox.imu = imu_.newest().reading;
  inbox.imu.valid = inbox.imu.valid && now_us - imu_.newest().received_us <= kImuSilent_us;
  orders_.pop(inbox.command);
  if (terminating_.load(std::memory_order_relaxed)) {
    inbox.faults |= climb::flag(climb::Fault::kTerminate);
  }
}

void ControlThread::cycle(std::int64_t deadline_us) {
  const std::int64_t begin_us = time_us(CLOCK_MONOTONIC);
  CycleInbox inbox;
  inbox.faults = clock_.begin(begin_us, time_us(CLOCK_BOOTTIME));
  fill_inbox(begin_us, inbox);
  CycleNews& news = news_.writing();
  cycle_.step(begin_us, inbox, news.report);
  serve_requests();
  news.utime_us = time_us(CLOCK_REALTIME);
  news.num_cycles = clock_.num_cycles();
  news.num_overruns = clock_.num_overruns();
  news_.publish();
  const std::int64_t end_us = time_us(CLOCK_MONOTONIC);
  timings_.push({static_cast<std::int32_t>(end_us - begin_us),
                 static_cast<std::int32_t>(begin_us - deadline_us)});
  constexpr std::uint64_t kOne = 1;
  [[maybe_unused]] const ssize_t size = ::write(news_fd_, &kOne, sizeof kOne);
}

void ControlThread::serve_requests() {
  if (handing_over_.load(std::memory_order_relaxed)) {
    if (cycles_since_hand_over_ == 0) cycle_.hand_over();
    if (++cycles_since_hand_over_ >= kHandOverCycles) handed_over_ = true;
  }
  if (flight_wanted_.load(std::memory_order_relaxed) &&
      !flight_ready_.load(std::memory_order_acquire)) {
    flight_wanted_ = false;
    flight_ = recorder_;  // same sizes: nothing is allocated
    flight_ready_.store(true, std::memory_order_release);
  }
}

}  // namespace climb_controller
