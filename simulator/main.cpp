// SPDX-License-Identifier: BSD-3-Clause
// ladder_simulator: publishes a simulated robot's sensors live on LCM, or writes them to an LCM log
// as fast as it can. Exit codes: 0 done or asked to stop, 2 wrong arguments, 3 LCM or file missing.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <exception>
#include <fstream>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>
#include <lcm/lcm-cpp.hpp>

#include "runtime/bus.h"
#include "runtime/channels.h"
#include "simulator/simulation.h"
#include "simulator/simulation_options.h"

namespace {

constexpr int kExitArguments = 2;
constexpr int kExitNoDevice = 3;
/// A log's own time: the same arguments give the same bytes.
constexpr std::int64_t kLogStart_us = 1'767'225'600'000'000;  // 2026-01-01

volatile std::sig_atomic_t stop_requested = 0;
void request_stop(int) {
  stop_requested = 1;
}

struct Arguments {
  simulator::SimulationParams simulation;
  std::optional<double> seconds;
  std::optional<std::int64_t> num_frames;
  std::string log_path;
  std::string url;
  std::string depth_pgm_path;
};

const auto& channel_of(const ladder_msgs::tof_frame_t& frame) {
  return runtime::channels::kTof[static_cast<std::size_t>(frame.head)];
}
const auto& channel_of(const ladder_msgs::imu_t&) {
  return runtime::channels::kImu;
}
const auto& channel_of(const ladder_msgs::truth_t&) {
  return runtime::channels::kTruth;
}

std::vector<std::uint8_t> encoded(const simulator::Message& message) {
  return std::visit(
      [](const auto& value) {
        std::vector<std::uint8_t> bytes(static_cast<std::size_t>(value.getEncodedSize()));
        value.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
        return bytes;
      },
      message);
}

/// An exit code when there is nothing to run. Throws std::invalid_argument.
std::optional<int> parse(int argc, char** argv, Arguments& arguments) {
  CLI::App app("Simulated depth heads and inertial unit before a scene.", "ladder_simulator");
  const simulator::SimulationOptions options(app);
  app.add_option("--seconds", arguments.seconds, "stop after this time");
  app.add_option("--frames", arguments.num_frames, "stop after so many frames of each head");
  app.add_option("--log", arguments.log_path, "write this LCM log instead of publishing");
  app.add_option("--url", arguments.url, "LCM provider, default LCM_DEFAULT_URL");
  app.add_option("--depth_pgm", arguments.depth_pgm_path,
                 "write the first frame of head 0..3 as PATH0.pgm .. and stop");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kExitArguments;  // 0: help was asked for
  }
  arguments.simulation = options.params();
  if (!arguments.log_path.empty() && !arguments.seconds && !arguments.num_frames) {
    throw std::invalid_argument("--log needs --frames or --seconds");
  }
  return std::nullopt;
}

/// Time after which nothing is sent; the last frame's round is complete.
std::int64_t end_utime_us(const Arguments& arguments) {
  constexpr std::int64_t kNever = INT64_MAX;
  const std::int64_t start = arguments.simulation.start_utime_us;
  std::int64_t end = kNever;
  if (arguments.seconds) end = start + static_cast<std::int64_t>(*arguments.seconds * 1e6);
  if (arguments.num_frames) {
    const double period_us = 1e6 / arguments.simulation.rate_hz;
    end = std::min(
        end, start - 1 +
                 static_cast<std::int64_t>(period_us * static_cast<double>(*arguments.num_frames)));
  }
  return end;
}

int write_log(const Arguments& arguments) {
  simulator::Simulation simulation(arguments.simulation);
  lcm::LogFile log(arguments.log_path, "w");
  if (!log.good()) {
    std::fprintf(stderr, "ladder_simulator: cannot write %s\n", arguments.log_path.c_str());
    return kExitNoDevice;
  }
  const std::int64_t end = end_utime_us(arguments);
  std::int64_t event_number = 0;
  while (simulation.next_utime_us() <= end && stop_requested == 0) {
    for (const auto& message : simulation.advance_to(simulation.next_utime_us())) {
      std::vector<std::uint8_t> bytes = encoded(message);
      lcm::LogEvent event{};
      event.eventnum = event_number++;
      event.timestamp = simulator::utime_us(message);
      event.channel = std::visit([](const auto& value) { return channel_of(value).name; }, message);
      event.datalen = static_cast<int>(bytes.size());
      event.data = bytes.data();
      if (log.writeEvent(&event) != 0) {
        std::fprintf(stderr, "ladder_simulator: cannot write to %s (disk full?)\n",
                     arguments.log_path.c_str());
        return kExitNoDevice;
      }
    }
  }
  return 0;
}

std::int64_t system_utime_us() {
  using std::chrono::system_clock;
  return std::chrono::duration_cast<std::chrono::microseconds>(
             system_clock::now().time_since_epoch())
      .count();
}

int publish_live(const Arguments& arguments) {
  runtime::Bus bus(arguments.url);
  simulator::Simulation simulation(arguments.simulation);
  const std::int64_t end = end_utime_us(arguments);
  while (stop_requested == 0 && simulation.next_utime_us() <= end) {
    const std::int64_t wait_us = simulation.next_utime_us() - system_utime_us();
    if (wait_us > 0) {
      // Short naps, so that a signal or a step of the clock is noticed soon.
      std::this_thread::sleep_for(
          std::chrono::microseconds(std::min<std::int64_t>(wait_us, 20'000)));
      continue;
    }
    for (const auto& message : simulation.advance_to(simulation.next_utime_us())) {
      std::visit([&bus](const auto& value) { bus.publish(channel_of(value), value); }, message);
    }
  }
  return 0;
}

/// Depth as 16-bit grey images, to look at.
int write_depth_images(const Arguments& arguments) {
  simulator::Simulation simulation(arguments.simulation);
  for (const auto& message : simulation.advance_to(arguments.simulation.start_utime_us + 60'000)) {
    const auto* frame = std::get_if<ladder_msgs::tof_frame_t>(&message);
    if (frame == nullptr) continue;
    std::ofstream file(arguments.depth_pgm_path + std::to_string(static_cast<int>(frame->head)) +
                       ".pgm");
    file << "P2\n" << frame->width_px << ' ' << frame->height_px << "\n4095\n";
    for (const std::int16_t depth_mm : frame->depth_mm)
      file << std::min<int>(depth_mm, 4095) << '\n';
    if (!file) return kExitNoDevice;
  }
  return 0;
}

int run(Arguments& arguments) {
  if (!arguments.depth_pgm_path.empty()) return write_depth_images(arguments);
  const bool live = arguments.log_path.empty();
  arguments.simulation.start_utime_us = live ? system_utime_us() : kLogStart_us;
  return live ? publish_live(arguments) : write_log(arguments);
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGTERM, request_stop);
  std::signal(SIGINT, request_stop);
  Arguments arguments;
  try {
    if (const std::optional<int> exit_code = parse(argc, argv, arguments)) return *exit_code;
    return run(arguments);
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "ladder_simulator: %s\n", error.what());
    return kExitArguments;
  } catch (const runtime::BusError& error) {
    std::fprintf(stderr, "ladder_simulator: %s\n", error.what());
    return kExitNoDevice;
  }
}
