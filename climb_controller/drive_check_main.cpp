// SPDX-License-Identifier: BSD-3-Clause
// ladder-drive-check: one CiA 402 drive, before it goes into the robot. Exit
// codes: 0 fit (with --ground also: works on the ground), 1 does not work, 2 wrong arguments, 3
// works, but is not fit for climbing, 4 the CAN line cannot be opened.
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "can/can_socket.h"
#include "climb_controller/drive_check.h"

namespace {

using climb_controller::DriveCheck;
using climb_controller::DriveCheckParams;
using climb_controller::DriveVerdict;

enum ExitCode { kFit = 0, kUnfit = 1, kArguments = 2, kGroundOnly = 3, kNoLine = 4 };

volatile std::sig_atomic_t stop_requested = 0;
void request_stop(int) {
  stop_requested = 1;
}

struct Arguments {
  std::string can = "can0";
  int node = 1;
  bool ground = false;
  std::string candump_path;
  std::vector<std::string> optional_objects;
  DriveCheckParams check;
};

/// "607Dh:1", "607D:1", "605E".
bool parse_object(const std::string& text, can::cia402::Object& object) {
  char* end = nullptr;
  const unsigned long index = std::strtoul(text.c_str(), &end, 16);
  unsigned long subindex = 0;
  if (end == text.c_str() || index > 0xFFFF) return false;
  if (*end == 'h') ++end;
  if (*end == ':') subindex = std::strtoul(end + 1, &end, 10);
  if (*end != '\0' || subindex > 255) return false;
  object = {static_cast<std::uint16_t>(index), static_cast<std::uint8_t>(subindex)};
  return true;
}

void declare(CLI::App& app, Arguments& arguments) {
  can::AxisConfig& axis = arguments.check.axis;
  app.add_option("--can", arguments.can, "CAN interface (up, with its bitrate) or unix:PATH")
      ->required();
  app.add_option("--node", arguments.node, "node id, 1..126")->required();
  app.add_option("--move-rad", arguments.check.move_rad,
                 "switch torque on, move so far and back; 0 (default): no torque");
  app.add_option("--speed-rad-s", arguments.check.speed_rad_s, "top speed of that move");
  app.add_option("--counts-per-rad", axis.counts_per_rad, "position units per radian of the motor");
  app.add_option("--gear", axis.gear, "motor turns per joint turn");
  app.add_option("--sign", axis.sign, "+1 or -1");
  app.add_option("--cycle-us", arguments.check.cycle_us, "SYNC period");
  app.add_option("--accept", arguments.optional_objects,
                 "object that may be absent or other, e.g. 607D:1; may be repeated")
      ->allow_extra_args(false);
  app.add_flag("--reset-fault", arguments.check.reset_fault, "reset a drive found in fault, once");
  app.add_flag("--ground", arguments.ground, "a drive for ground tests passes too");
  app.add_option("--candump", arguments.candump_path, "write all frames there, as candump -L does");
}

/// "" or what is wrong.
std::string complete(Arguments& arguments) {
  if (arguments.node < 1 || arguments.node > 126) return "--node is 1..126";
  arguments.check.axis.node_id = static_cast<std::uint8_t>(arguments.node);
  // Never more than the drive calls its rated torque.
  arguments.check.axis.max_torque_Nm = arguments.check.axis.rated_torque_Nm;
  for (const std::string& text : arguments.optional_objects) {
    can::cia402::Object object;
    if (!parse_object(text, object)) return "--accept " + text + ": INDEX[:SUBINDEX] in hex";
    arguments.check.optional_objects.push_back(object);
  }
  return climb_controller::check(arguments.check);
}

std::int64_t now_us() {
  timespec time{};
  ::clock_gettime(CLOCK_MONOTONIC, &time);
  return std::int64_t{time.tv_sec} * 1'000'000 + time.tv_nsec / 1000;
}

void sleep_until(std::int64_t time_us) {
  const timespec time{time_us / 1'000'000, time_us % 1'000'000 * 1000};
  while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr) == EINTR &&
         stop_requested == 0) {
  }
}

void run(DriveCheck& check, std::int64_t cycle_us) {
  std::int64_t next_cycle_us = now_us();
  bool was_cancelled = false;
  while (!check.is_done()) {
    if (stop_requested != 0 && !was_cancelled) {
      was_cancelled = true;
      check.cancel();
    }
    check.cycle(now_us());
    next_cycle_us = std::max(next_cycle_us + cycle_us, now_us());
    while (now_us() < next_cycle_us && !check.is_done()) {
      sleep_until(std::min(next_cycle_us, now_us() + 1000));
      check.poll(now_us());
    }
  }
}

int exit_code(DriveVerdict verdict, bool ground) {
  switch (verdict) {
    case DriveVerdict::kFit:
      return kFit;
    case DriveVerdict::kGroundOnly:
      return ground ? kFit : kGroundOnly;
    case DriveVerdict::kUnfit:
      break;
  }
  return kUnfit;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app(
      "One CiA 402 drive, before it goes into the robot: who it is, whether every object can be "
      "brought to what climbing needs, and what it lacks. Nothing is stored in the drive. With "
      "--move-rad its shaft must be free to turn.",
      "ladder-drive-check");
  declare(app, arguments);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kArguments;
  }
  const std::string problem = complete(arguments);
  if (!problem.empty()) {
    std::fprintf(stderr, "ladder-drive-check: %s\n", problem.c_str());
    return kArguments;
  }
  can::CanSocket line(can::CanSocketParams{arguments.can});
  const std::string no_line = line.open();
  if (!no_line.empty()) {
    std::fprintf(stderr, "ladder-drive-check: %s\n", no_line.c_str());
    return kNoLine;
  }
  std::signal(SIGINT, request_stop);
  std::signal(SIGTERM, request_stop);
  can::FlightRecorder recorder(1 << 16);
  DriveCheck check(arguments.check, line, &recorder);
  run(check, arguments.check.cycle_us);
  std::fputs(text_of(check.report(), arguments.check).c_str(), stdout);
  if (!arguments.candump_path.empty()) {
    std::ofstream file(arguments.candump_path);
    recorder.write_candump(file, "can0");
  }
  return exit_code(check.report().verdict, arguments.ground);
}
