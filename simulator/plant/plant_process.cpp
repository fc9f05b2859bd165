// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/plant/plant_process.h"

#include <chrono>
#include <csignal>
#include <cstdio>
#include <stdexcept>

#include <CLI/CLI.hpp>
#include <sched.h>

namespace simulator {
namespace {

constexpr int kPriority = 40;

volatile std::sig_atomic_t stop_requested = 0;
volatile std::sig_atomic_t num_dock_signals = 0;
volatile std::sig_atomic_t num_estop_signals = 0;

void on_signal(int signal) {
  if (signal == SIGUSR1) {
    num_dock_signals = num_dock_signals + 1;
  } else if (signal == SIGUSR2) {
    num_estop_signals = num_estop_signals + 1;
  } else {
    stop_requested = 1;
  }
}

template <class Clock>
std::int64_t microseconds() {
  return std::chrono::duration_cast<std::chrono::microseconds>(Clock::now().time_since_epoch())
      .count();
}

}  // namespace

HandSignals::HandSignals() {
  for (const int signal : {SIGTERM, SIGINT, SIGUSR1, SIGUSR2}) std::signal(signal, on_signal);
}

bool HandSignals::is_stop_requested() const {
  return stop_requested != 0;
}

void HandSignals::obey(RobotPlant& plant) {
  const int num_dock = num_dock_signals;
  const int num_estop = num_estop_signals;
  if ((num_dock - num_dock_obeyed_) % 2 != 0) plant.set_docked(!plant.is_docked());
  if (num_estop != num_estop_obeyed_) plant.press_estop(num_estop % 2 != 0);
  num_dock_obeyed_ = num_dock;
  num_estop_obeyed_ = num_estop;
}

PlantClock::PlantClock(std::int64_t max_catch_up_us)
    : max_catch_up_us_(max_catch_up_us), start_us_(microseconds<std::chrono::steady_clock>()) {}

std::int64_t PlantClock::advance() {
  wall_us_ = microseconds<std::chrono::steady_clock>() - start_us_;
  const std::int64_t behind_us = wall_us_ - skipped_us_ - now_us_;
  if (behind_us > max_catch_up_us_) skipped_us_ += behind_us - max_catch_up_us_;
  now_us_ = wall_us_ - skipped_us_;
  return now_us_;
}

std::int64_t utime_us() {
  return microseconds<std::chrono::system_clock>();
}

void stand_for_hardware() {
  sched_param priority{};
  priority.sched_priority = kPriority;
  static_cast<void>(sched_setscheduler(0, SCHED_FIFO, &priority));
}

int exit_code_of(const char* name, int (*run)(int argc, char** argv), int argc, char** argv) {
  int exit_code = kExitArguments;
  try {
    return run(argc, argv);
  } catch (const CLI::CallForHelp&) {
    return 0;
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "%s: %s\n", name, error.what());
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "%s: %s\n", name, error.what());
  } catch (const std::runtime_error& error) {
    exit_code = kExitNoDoor;
    std::fprintf(stderr, "%s: %s\n", name, error.what());
  }
  return exit_code;
}

}  // namespace simulator
