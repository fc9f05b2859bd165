// SPDX-License-Identifier: BSD-3-Clause
// ladder_replay: reads head frames, IMU, pose and joints from a log, runs the perception chain over
// every one of them as fast as it can, and writes clouds, topologies and rungs (and the recorded
// truth) to another log. Two runs give the same bytes.
#include <array>
#include <chrono>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <lcm/lcm-cpp.hpp>

#include "robot_in_a_box/byte_hash.h"
#include "robot_in_a_box/chain.h"

namespace {

constexpr std::array<std::string_view, 7> kInputs = {"LADDER_TOF_0", "LADDER_TOF_1", "LADDER_TOF_2",
                                                     "LADDER_TOF_3", "LADDER_IMU",   "LADDER_POSE",
                                                     "LADDER_CLIMB"};
constexpr std::string_view kTruth = "LADDER_TRUTH";

struct Arguments {
  std::string in, out;
  std::vector<std::string> config_files, overrides;
};

struct Counts {
  int in = 0, out = 0;
  std::int64_t rejected = 0;
  robot_in_a_box::ByteHash made;  ///< what the chain made, without what is copied
};

/// Throws std::runtime_error where a log cannot be opened or written.
Counts replay(const Arguments& arguments) {
  lcm::LogFile in(arguments.in, "r");
  if (!in.good()) throw std::runtime_error(arguments.in + ": cannot be read");
  lcm::LogFile out(arguments.out, "w");
  if (!out.good()) throw std::runtime_error(arguments.out + ": cannot be written");

  Counts counts;
  std::int64_t timestamp_us = 0;
  const auto write = [&](const char* channel, const void* bytes, std::size_t num_bytes) {
    lcm::LogEvent event{};
    event.eventnum = counts.out++;
    event.timestamp = timestamp_us;
    event.channel = channel;
    event.data = const_cast<void*>(bytes);  // NOLINT: LCM's structure has no const
    event.datalen = static_cast<std::int32_t>(num_bytes);
    if (out.writeEvent(&event) != 0)
      throw std::runtime_error(arguments.out + ": writing failed; is the disk full?");
  };

  std::vector<std::string> overrides = arguments.overrides;
  overrides.emplace_back("sensor.source=lcm");  // the log delivers, whatever the robot has
  robot_in_a_box::Chain chain(runtime::Config::load(arguments.config_files, overrides));
  std::string write_error;
  chain.record({"LADDER_CLOUD", "LADDER_TOPOLOGY", "LADDER_RUNGS"},
               [&](const char* channel, const void* bytes, std::size_t num_bytes) {
                 counts.made.add(channel, bytes, num_bytes);
                 try {  // called from C code
                   write(channel, bytes, num_bytes);
                 } catch (const std::exception& error) {
                   write_error = error.what();
                 }
               });
  while (const lcm::LogEvent* event = in.readNextEvent()) {
    timestamp_us = event->timestamp;
    const auto num_bytes = static_cast<std::size_t>(event->datalen);
    if (event->channel == kTruth) write(event->channel.c_str(), event->data, num_bytes);
    for (const std::string_view input : kInputs) {
      if (event->channel != input) continue;
      ++counts.in;
      chain.feed(event->channel, event->data, num_bytes, timestamp_us);
    }
    if (!write_error.empty()) throw std::runtime_error(write_error);
  }
  counts.rejected = chain.num_rejected();
  return counts;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Runs the perception chain over a recorded log: every frame, as fast as possible, the same "
      "bytes each time."};
  Arguments arguments;
  app.add_option("in", arguments.in,
                 "LCM log with LADDER_TOF_*, LADDER_IMU, LADDER_POSE, LADDER_CLIMB")
      ->required();
  app.add_option("-o,--out", arguments.out, "LCM log to write")->required();
  app.add_option("-c,--config", arguments.config_files, "TOML file; later ones win");
  app.add_option("--set", arguments.overrides, "table.key=value, wins over the files")
      ->allow_extra_args(false);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? runtime::kExitAsked : runtime::kExitConfiguration;
  }
  try {
    const auto start = std::chrono::steady_clock::now();
    const Counts counts = replay(arguments);
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::fprintf(stderr, "replayed %d messages in %.2f s, %d written, %lld rejected\n", counts.in,
                 seconds, counts.out, static_cast<long long>(counts.rejected));
    std::printf("%lld messages, hash %016llx\n", static_cast<long long>(counts.made.num_messages()),
                static_cast<unsigned long long>(counts.made.value()));
    if (counts.in == 0) {
      std::fprintf(stderr,
                   "%s holds no LADDER_TOF_*, LADDER_IMU or LADDER_POSE message before its end or "
                   "first damage\n",
                   arguments.in.c_str());
      return runtime::kExitDevice;
    }
    return runtime::kExitAsked;
  } catch (const runtime::ConfigError& error) {
    std::fprintf(stderr, "configuration: %s\n", error.what());
    return runtime::kExitConfiguration;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return runtime::kExitDevice;
  }
}
