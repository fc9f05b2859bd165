// SPDX-License-Identifier: BSD-3-Clause
// ladder_drill: the fault table, random faults and sudden death of the controller, all in virtual
// time. Exit codes: 0 nothing missed, 1 something missed or not run, 2 wrong arguments.
#include <cstdio>
#include <fstream>

#include <CLI/CLI.hpp>

#include "robot_in_a_box/drill.h"

namespace {

using namespace robot_in_a_box;

constexpr int kExitMissed = 1;
constexpr int kExitArguments = 2;

struct Arguments {
  DrillOptions drill;
  std::vector<int> rows;
  std::string json_path;
  std::string case_name;
};

void parse(int argc, char** argv, Arguments& arguments) {
  CLI::App app("Faults upon the climbing robot, in virtual time.", "ladder_drill");
  app.add_option("--json", arguments.json_path, "where the results go");
  app.add_option("--rows", arguments.rows, "only these rows of the fault table")->delimiter(',');
  app.add_option("--jobs", arguments.drill.num_jobs, "copies at a time; 0 = one per processor");
  app.add_option("--every", arguments.drill.every, "only each n-th situation")
      ->check(CLI::PositiveNumber);
  app.add_option("--case", arguments.case_name, "one case again, told step by step");
  app.parse(argc, argv);
  arguments.drill.rows.insert(arguments.rows.begin(), arguments.rows.end());
}

double ms(std::int64_t time_us) {
  return 1e-3 * static_cast<double>(time_us);
}

int print(const DrillScore& score, const DrillOptions& options) {
  int num_missed = 0;
  std::printf("%-4s %-32s %-34s %6s %6s %6s %9s %9s\n", "row", "fault", "injected", "cases",
              "missed", "unseen", "bound ms", "worst ms");
  for (const RowScore& row : score.rows) {
    if (!options.rows.empty() && options.rows.count(row.row->number) == 0) continue;
    const std::string id = std::to_string(row.row->number) + row.row->part;
    std::printf("%-4s %-32.32s %-34.34s %6d %6d %6d %9.1f %9.1f\n", id.c_str(), row.row->fault,
                row.row->injected, row.cases, row.missed, row.unseen, ms(row.row->bound_us),
                ms(row.worst_us));
    num_missed += row.missed;
    for (const std::string& miss : row.misses) std::printf("       %s\n", miss.c_str());
  }
  std::printf("%d situations, %d missed\n", score.num_situations, num_missed);
  return num_missed;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  try {
    parse(argc, argv, arguments);
  } catch (const CLI::CallForHelp& help) {
    std::puts(CLI::App{}.help().c_str());
    return 0;
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return kExitArguments;
  }
  if (!arguments.case_name.empty()) {
    const auto tell = [](const std::string& line) { std::puts(line.c_str()); };
    return replay_case(arguments.case_name, arguments.drill.seed, tell) ? 0 : kExitArguments;
  }
  const DrillScore score = run_drill(arguments.drill);
  return print(score, arguments.drill) == 0 ? 0 : kExitMissed;
}
