// SPDX-License-Identifier: BSD-3-Clause
// What the programs that stand for the robot's hardware have in common as processes: a tester's
// signals, real time, exit codes.
#pragma once

#include <cstdint>

#include "simulator/plant/robot_plant.h"

namespace simulator {

/// A tester's hand: SIGUSR1 releases the dock and holds the body again where it is, SIGUSR2 presses
/// and releases the E-stop; SIGTERM and SIGINT ask the program to stop. One per process.
class HandSignals {
 public:
  HandSignals();

  bool is_stop_requested() const;
  /// What was signalled since the last call.
  void obey(RobotPlant& plant);

 private:
  int num_dock_obeyed_ = 0;
  int num_estop_obeyed_ = 0;
};

/// The plant's time. It follows the monotonic clock; a process that was held up goes on from where
/// it is, it does not run after lost seconds.
class PlantClock {
 public:
  explicit PlantClock(std::int64_t max_catch_up_us);

  /// The plant's time now: at most max_catch_up_us after the last one.
  std::int64_t advance();
  std::int64_t now_us() const { return now_us_; }    ///< as of the last advance()
  std::int64_t wall_us() const { return wall_us_; }  ///< since the start, with what was skipped

 private:
  std::int64_t max_catch_up_us_;
  std::int64_t start_us_;
  std::int64_t skipped_us_ = 0;
  std::int64_t wall_us_ = 0;
  std::int64_t now_us_ = 0;
};

/// Of the system's clock: what messages carry.
std::int64_t utime_us();

/// Drives do not wait for other programs: real-time where permitted, below the controller's.
void stand_for_hardware();

constexpr int kExitArguments = 2;
constexpr int kExitNoDoor = 3;

/// `run` with its exceptions told as "name: what": CLI::ParseError and std::invalid_argument are
/// kExitArguments, std::runtime_error (a door that cannot be opened) kExitNoDoor, help 0.
int exit_code_of(const char* name, int (*run)(int argc, char** argv), int argc, char** argv);

}  // namespace simulator
