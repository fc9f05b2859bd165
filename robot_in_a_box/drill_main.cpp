// SPDX-License-Identifier: BSD-3-Clause
// ladder_drill: the fault table, random troubles under the nine invariants, and sudden deaths of
// the controller, all in virtual time. Exit codes: 0 nothing missed, 1 something missed or not run,
// 2 wrong arguments, 3 the results cannot be written.
#include <cstdio>
#include <cstdlib>

#include <CLI/CLI.hpp>

#include "robot_in_a_box/drill_configuration.h"
#include "robot_in_a_box/drill_report.h"

namespace {

using namespace robot_in_a_box;

constexpr int kExitMissed = 1;
constexpr int kExitArguments = 2;
constexpr int kExitNotWritten = 3;
constexpr int kConfigurationRow = 29;

struct Arguments {
  DrillOptions drill;
  std::vector<int> rows;
  std::string json_path;
  std::string case_name;
  std::uint64_t first_seed = 1;
  int num_seeds = -1;
  int num_kills = -1;
};

/// Throws CLI::ParseError.
void parse(int argc, char** argv, Arguments& arguments, CLI::App& app) {
  app.add_option("--json", arguments.json_path, "where the results go");
  app.add_option("--rows", arguments.rows, "only these rows of the fault table; 0 = none")
      ->delimiter(',');
  app.add_option("--seeds", arguments.num_seeds, "random runs (default 1000; 0 with --rows)");
  app.add_option("--first-seed", arguments.first_seed, "of the random runs");
  app.add_option("--kills", arguments.num_kills, "deaths of the controller (default 200)");
  app.add_option("--jobs", arguments.drill.num_jobs, "copies at a time; 0 = one per processor");
  app.add_option("--every", arguments.drill.every, "only each n-th situation")
      ->check(CLI::PositiveNumber);
  app.add_option("--misses", arguments.drill.num_misses_told, "told per row (default 5)");
  app.add_option("--case", arguments.case_name, "one case again, told step by step");
  app.parse(argc, argv);
  arguments.drill.rows.insert(arguments.rows.begin(), arguments.rows.end());
  const bool is_partial = !arguments.rows.empty();
  if (arguments.num_seeds < 0) arguments.num_seeds = is_partial ? 0 : 1000;
  if (arguments.num_kills < 0) arguments.num_kills = is_partial ? 0 : 200;
}

bool is_wanted(const DrillOptions& options, int row) {
  return options.rows.empty() || options.rows.count(row) > 0;
}

DrillReport run(const Arguments& arguments) {
  DrillReport report;
  const DrillOptions& options = arguments.drill;
  for (int row = 1; row <= 32; ++row) {
    if (!is_wanted(options, row)) report.not_asked_for.insert(row);
  }
  if (report.not_asked_for.size() < 32) report.table = run_drill(options);
  if (is_wanted(options, kConfigurationRow)) {
    report.table.rows.push_back(drill_configuration(configuration_row()));
  }
  report.kills = run_kills(arguments.first_seed, arguments.num_kills, options.num_jobs);
  report.seeds = run_random(arguments.first_seed, arguments.num_seeds, options.num_jobs);
  return report;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("Faults upon the climbing robot, in virtual time.", "ladder_drill");
  try {
    parse(argc, argv, arguments, app);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kExitArguments;
  }
  if (!arguments.case_name.empty()) {
    const auto tell = [](const std::string& line) { std::puts(line.c_str()); };
    const std::string& wanted = arguments.case_name;
    if (wanted.rfind("seed:", 0) == 0) {
      tell_seed(std::strtoull(wanted.c_str() + 5, nullptr, 10), tell);
      return 0;
    }
    return replay_case(arguments.case_name, arguments.drill.seed, tell) ? 0 : kExitArguments;
  }
  const DrillReport report = run(arguments);
  print(report);
  if (!arguments.json_path.empty() && !write_json(report, arguments.json_path)) {
    std::fprintf(stderr, "cannot write %s\n", arguments.json_path.c_str());
    return kExitNotWritten;
  }
  return num_missed(report) == 0 && rows_not_run(report).empty() ? 0 : kExitMissed;
}
