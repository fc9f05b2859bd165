// SPDX-License-Identifier: BSD-3-Clause
// ladder_light_climbs: climbs of random ladders with random faults under the nine invariants, in
// virtual time. Exit codes: 0 no invariant violated, 1 one was, 2 wrong arguments, 3 the results
// cannot be written.
#include <cstdio>

#include <CLI/CLI.hpp>

#include "robot_in_a_box/climb_log.h"
#include "robot_in_a_box/light_climbs.h"

namespace {

using namespace robot_in_a_box;

constexpr int kExitViolated = 1;
constexpr int kExitArguments = 2;
constexpr int kExitNotWritten = 3;

struct Arguments {
  int num_climbs = 200;
  int num_jobs = 0;
  std::uint64_t first_seed = 1;
  bool tells = false;
  std::string json_path, log_path;
  LightClimbParams climb;
};

/// Throws CLI::ParseError.
void parse(int argc, char** argv, Arguments& arguments, CLI::App& app) {
  app.add_option("--climbs", arguments.num_climbs, "how many")->check(CLI::PositiveNumber);
  app.add_option("--first-seed", arguments.first_seed, "of the climbs");
  app.add_option("--rungs", arguments.climb.num_rungs_to_climb, "rungs above the start")
      ->check(CLI::Range(1, 100));
  app.add_option("--jobs", arguments.num_jobs, "copies at a time; 0 = one per processor");
  app.add_option("--json", arguments.json_path, "where the results go");
  app.add_flag("!--no-troubles", arguments.climb.has_troubles, "random ladders alone");
  app.add_flag("--tell", arguments.tells, "only the first seed, told step by step");
  app.add_option("--log", arguments.log_path, "only the first seed, as an LCM log");
  app.parse(argc, argv);
}

int run_one(const Arguments& arguments) {
  LightClimbParams params = arguments.climb;
  params.seed = arguments.first_seed;
  ClimbBox box(light_box_params(params));
  ClimbLog log(arguments.log_path);
  const auto tell = [&](const std::string& line) {
    if (arguments.tells) std::puts(line.c_str());
  };
  const LightResult result = run_light_climb(
      params, box, [&] { log.write(box); }, tell);
  std::printf("seed %llu: %s %s, %d rungs, frames %016llx, %lld violations\n",
              static_cast<unsigned long long>(params.seed), name(result.end), result.reason,
              result.rungs_climbed, static_cast<unsigned long long>(box.frame_hash()),
              static_cast<long long>(box.monitor().num_violations()));
  if (!log.good()) {
    std::fprintf(stderr, "cannot write %s\n", arguments.log_path.c_str());
    return kExitNotWritten;
  }
  return box.monitor().num_violations() == 0 ? 0 : kExitViolated;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("Light climbs with random faults, in virtual time.", "ladder_light_climbs");
  try {
    parse(argc, argv, arguments, app);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kExitArguments;
  }
  if (arguments.tells || !arguments.log_path.empty()) return run_one(arguments);
  const auto scores = run_light_climbs(arguments.first_seed, arguments.num_climbs,
                                       arguments.num_jobs, arguments.climb);
  print(scores);
  if (!arguments.json_path.empty() && !write_json(scores, arguments.json_path)) {
    std::fprintf(stderr, "cannot write %s\n", arguments.json_path.c_str());
    return kExitNotWritten;
  }
  return num_violated(scores) == 0 ? 0 : kExitViolated;
}
