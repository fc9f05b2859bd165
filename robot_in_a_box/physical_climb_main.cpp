// SPDX-License-Identifier: BSD-3-Clause
// ladder_physical_climb: climbs in physics, one after another, one line each. Virtual time, rungs
// from truth with an error as perception makes it.
#include <chrono>
#include <cstdio>

#include <CLI/CLI.hpp>

#include "robot_in_a_box/physical_climb.h"

namespace {

using robot_in_a_box::ClimbEnd;
using robot_in_a_box::PhysicalClimb;
using robot_in_a_box::PhysicalClimbParams;

struct Arguments {
  std::uint64_t first_seed = 1;
  int num_seeds = 1;
  double spacing_m = 0.0;  ///< 0 = from the seed
  int num_rungs = 14;
  int damaged_rung = -1;
  std::string scene = "plain";
  double bias_mm = 5.0;
  double jitter_mm = 3.0;
  double tilt_deg = 1.0;
  bool down = false;
};

void parse(CLI::App& app, Arguments& arguments) {
  app.add_option("--first-seed", arguments.first_seed, "seed of the first climb");
  app.add_option("--seeds", arguments.num_seeds, "so many climbs")->check(CLI::PositiveNumber);
  app.add_option("--spacing", arguments.spacing_m, "of the rungs [m]; 0.25..0.35 from the seed");
  app.add_option("--rungs", arguments.num_rungs, "of the ladder");
  app.add_option("--scene", arguments.scene, "plain, bent, broken, missing ..");
  app.add_option("--damaged-rung", arguments.damaged_rung, "which, from 0; from the seed");
  app.add_option("--bias-mm", arguments.bias_mm, "error of a rung, +- per axis");
  app.add_option("--jitter-mm", arguments.jitter_mm, "error of a rung in one message, +- per axis");
  app.add_option("--tilt-deg", arguments.tilt_deg, "error of a rung's direction, +- per axis");
  app.add_flag("--down", arguments.down, "back into the dock afterwards");
}

PhysicalClimbParams climb_of(const Arguments& arguments, std::uint64_t seed) {
  PhysicalClimbParams params;
  base::Rng rng(seed, 7);
  params.seed = seed;
  params.scene.kind = simulator::scene_kind_from_string(arguments.scene);
  params.scene.seed = seed;
  params.scene.num_rungs = arguments.num_rungs;
  params.scene.spacing_m = 0.25 + 0.10 * rng.uniform();
  if (arguments.spacing_m > 0.0) params.scene.spacing_m = arguments.spacing_m;
  if (arguments.damaged_rung >= 0) params.scene.damaged_rung = arguments.damaged_rung;
  params.perception.bias_m = 1e-3 * arguments.bias_mm;
  params.perception.jitter_m = 1e-3 * arguments.jitter_mm;
  params.perception.tilt_rad = arguments.tilt_deg * 3.14159265358979 / 180.0;
  return params;
}

/// True: as it should end.
bool run(const Arguments& arguments, std::uint64_t seed) {
  const PhysicalClimbParams params = climb_of(arguments, seed);
  const auto begin = std::chrono::steady_clock::now();
  PhysicalClimb climb(params);
  const bool hangs = climb.hang();
  ClimbEnd end = hangs ? climb.climb(true, 1200.0) : ClimbEnd::kFault;
  std::string reason = climb.reason();
  bool is_good = end == ClimbEnd::kTop;
  if (is_good && arguments.down) {
    end = climb.climb(false, 1200.0);
    reason = climb.reason();
    is_good = end == ClimbEnd::kDock && climb.back_into_dock();
  }
  const double wall_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const simulator::Figures& f = climb.figures();
  std::printf(
      "seed %llu spacing %.3f %s%s '%s' rungs %d falls %d tried %d failed %d support %d %.0f s "
      "%.1f Nm %.0f N drift %.1f mm violations %zu wall %.1f s rtf %.1f\n",
      static_cast<unsigned long long>(seed), params.scene.spacing_m, name(end),
      is_good ? "" : (hangs ? " BAD" : " BAD does not hang"), reason.c_str(), f.rungs_climbed,
      f.falls, f.grasps_tried, f.grasps_failed, f.min_support, f.seconds, f.peak_joint_torque_Nm,
      f.peak_grip_N, f.pose_drift_mm, climb.box().monitor().violations().size(), wall_s,
      1e-6 * static_cast<double>(climb.box().now_us()) / wall_s);
  for (const simulator::Violation& violation : climb.box().monitor().violations()) {
    std::printf("  %s\n", describe(violation).c_str());
  }
  std::fflush(stdout);
  return is_good;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Climbs of the robot in physics, in virtual time.", "ladder_physical_climb");
  Arguments arguments;
  parse(app, arguments);
  CLI11_PARSE(app, argc, argv);
  int num_good = 0;
  for (int i = 0; i < arguments.num_seeds; ++i) {
    num_good += run(arguments, arguments.first_seed + static_cast<std::uint64_t>(i)) ? 1 : 0;
  }
  std::printf("%d of %d\n", num_good, arguments.num_seeds);
  return num_good == arguments.num_seeds ? 0 : 1;
}
