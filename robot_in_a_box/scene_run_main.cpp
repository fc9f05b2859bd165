// SPDX-License-Identifier: BSD-3-Clause
// ladder_scene_run: one simulated scene through the perception chain in virtual time; its score as
// text, or as JSON on a file. scripts/score calls it for grids of scenes. Exit codes: 0 scored, 2
// wrong arguments or configuration, 3 the result cannot be written.
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "robot_in_a_box/scene_run.h"
#include "runtime/service.h"
#include "simulator/score/report.h"
#include "simulator/simulation_options.h"

namespace {

/// A log's own time, as ladder_simulator has it.
constexpr std::int64_t kStart_us = 1'767'225'600'000'000;  // 2026-01-01

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("One simulated scene through the perception chain, scored.", "ladder_scene_run");
  const simulator::SimulationOptions scene(app);
  robot_in_a_box::SceneRunParams params;
  std::vector<std::string> config_files, overrides;
  std::string json_path;
  bool no_odometry = false;
  app.add_option("--frames", params.num_frames, "of each head")->check(CLI::Range(1, 1'000'000));
  app.add_flag("--no_odometry", no_odometry, "a body that moves does not say so");
  app.add_option("--odometry_sigma_m", params.odometry_sigma_m);
  app.add_option("-c,--config", config_files, "TOML file; later ones win");
  app.add_option("--set", overrides, "table.key=value, wins over the files")
      ->allow_extra_args(false);
  app.add_option("--json", json_path, "write the metrics to this file");
  try {
    app.parse(argc, argv);
    params.simulation = scene.params();
    params.simulation.start_utime_us = kStart_us;
    params.odometry = !no_odometry;
    overrides.emplace_back("sensor.source=lcm");  // the simulator delivers, whatever the robot has
    const simulator::Score score =
        run_scene(params, runtime::Config::load(config_files, overrides));
    if (json_path.empty()) {
      std::fputs(to_text(score).c_str(), stdout);
      return runtime::kExitAsked;
    }
    std::ofstream file(json_path);
    file << to_json(score);
    return file.flush() ? runtime::kExitAsked : runtime::kExitDevice;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? runtime::kExitAsked : runtime::kExitConfiguration;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "ladder_scene_run: %s\n", error.what());
    return runtime::kExitConfiguration;
  }
}
