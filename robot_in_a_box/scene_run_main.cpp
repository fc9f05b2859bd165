// SPDX-License-Identifier: BSD-3-Clause
// ladder_scene_run: one simulated scene through the perception chain in virtual time; its score as
// text, or as JSON on a file, and as a log on request. scripts/score calls it for grids of scenes.
// Exit codes: 0 scored, 2 wrong arguments or configuration, 3 the result cannot be written.
#include <cstdio>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <lcm/lcm-cpp.hpp>

#include "robot_in_a_box/scene_run.h"
#include "runtime/service.h"
#include "simulator/score/report.h"
#include "simulator/simulation_options.h"

namespace {

/// A log's own time, as ladder_simulator has it.
constexpr std::int64_t kStart_us = 1'767'225'600'000'000;  // 2026-01-01

/// Everything that the services hear and say, and the truth.
class SceneLog {
 public:
  explicit SceneLog(const std::string& path) : file_(path, "w"), is_good_(file_.good()) {}

  void write(const char* channel, std::span<const std::uint8_t> bytes, std::int64_t time_us) {
    lcm::LogEvent event{};
    event.eventnum = num_events_++;
    event.timestamp = time_us;
    event.channel = channel;
    event.data = const_cast<std::uint8_t*>(bytes.data());  // NOLINT: LCM's structure has no const
    event.datalen = static_cast<std::int32_t>(bytes.size());
    is_good_ = is_good_ && file_.writeEvent(&event) == 0;
  }
  bool good() const { return is_good_; }

 private:
  lcm::LogFile file_;
  bool is_good_;
  std::int64_t num_events_ = 0;
};

/// False: the file cannot be written.
bool tell(const simulator::Score& score, const std::string& json_path) {
  if (json_path.empty()) {
    std::fputs(to_text(score).c_str(), stdout);
    return true;
  }
  std::ofstream file(json_path);
  file << to_json(score);
  return static_cast<bool>(file.flush());
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("One simulated scene through the perception chain, scored.", "ladder_scene_run");
  const simulator::SimulationOptions scene(app);
  robot_in_a_box::SceneRunParams params;
  std::vector<std::string> config_files, overrides;
  std::string json_path, log_path;
  bool no_odometry = false;
  app.add_option("--frames", params.num_frames, "of each head")->check(CLI::Range(1, 1'000'000));
  app.add_flag("--no_odometry", no_odometry, "a body that moves does not say so");
  app.add_option("--odometry_sigma_m", params.odometry_sigma_m);
  app.add_option("-c,--config", config_files, "TOML file; later ones win");
  app.add_option("--set", overrides, "table.key=value, wins over the files")
      ->allow_extra_args(false);
  app.add_option("--json", json_path, "write the metrics to this file");
  app.add_option("--log", log_path,
                 "write what was heard and said, and the truth, to this LCM log");
  try {
    app.parse(argc, argv);
    params.simulation = scene.params();
    params.simulation.start_utime_us = kStart_us;
    params.odometry = !no_odometry;
    overrides.emplace_back("sensor.source=lcm");  // the simulator delivers, whatever the robot has
    std::optional<SceneLog> log;
    if (!log_path.empty()) {
      log.emplace(log_path);
      params.listener = [&log](const char* channel, auto bytes, std::int64_t time_us) {
        log->write(channel, bytes, time_us);
      };
    }
    const simulator::Score score =
        run_scene(params, runtime::Config::load(config_files, overrides));
    const bool is_told = tell(score, json_path);
    if (is_told && (!log || log->good())) return runtime::kExitAsked;
    std::fprintf(stderr, "ladder_scene_run: cannot write %s\n",
                 (is_told ? log_path : json_path).c_str());
    return runtime::kExitDevice;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? runtime::kExitAsked : runtime::kExitConfiguration;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "ladder_scene_run: %s\n", error.what());
    return runtime::kExitConfiguration;
  }
}
