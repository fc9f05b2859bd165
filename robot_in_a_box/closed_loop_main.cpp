// SPDX-License-Identifier: BSD-3-Clause
// ladder_closed_loop: mishaps upon the whole climbing robot in virtual time, each kind many times
// at random instants (closed_loop.h). Writes one JSON line per climb. Behind
// scripts/closed_loop_drill. Exit codes: 0 nothing missed, 1 something was, 2 wrong arguments or
// configuration.
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "robot_in_a_box/closed_loop.h"
#include "robot_in_a_box/fork_pool.h"

namespace {

using robot_in_a_box::ClosedLoop;
using robot_in_a_box::ClosedLoopParams;
using robot_in_a_box::ClosedLoopResult;
using robot_in_a_box::Mishap;
using robot_in_a_box::MishapRow;

struct Arguments {
  std::vector<std::string> mishaps;
  int num_times = 20;
  std::uint64_t first_seed = 1;
  int num_rungs = 13;
  int num_jobs = 0;
  double most_pause_s = 8.0;
  std::string json_path;
  std::vector<std::string> config_files;
  std::vector<std::string> overrides;
  bool tells = false;
};

/// A climb that ended in a hold with its reason is followed by another one on the next ladder.
constexpr int kMaxMoreClimbs = 5;

ClosedLoopParams params_of(const Arguments& arguments, Mishap mishap, std::uint64_t seed) {
  ClosedLoopParams params;
  params.mishap = mishap;
  params.num_times = arguments.num_times;
  params.seed = seed;
  params.most_pause_s = arguments.most_pause_s;
  params.climb.climb.scene.seed = seed;
  params.climb.climb.scene.num_rungs = arguments.num_rungs;
  params.climb.climb.seed = seed;
  params.climb.perception.heads.seed = seed;
  return params;
}

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.1f", value);
  return text;
}

/// A string's quotes; ours hold nothing that needs escaping but these.
std::string quoted(std::string text) {
  for (char& c : text) c = c == '"' || c == '\\' || c == '\n' ? ' ' : c;
  return '"' + text + '"';
}

std::string json_line(const ClosedLoopParams& params, const ClosedLoopResult& result) {
  std::string line = "{\"mishap\": " + quoted(name(params.mishap));
  line += ", \"seed\": " + std::to_string(params.seed);
  line += ", \"falls\": " + std::to_string(result.falls);
  line += ", \"violations\": " + std::to_string(result.num_violations);
  line += ", \"min_support\": " + std::to_string(result.min_support);
  line += ", \"rungs_climbed\": " + std::to_string(result.rungs_climbed);
  line += ", \"missed\": [";
  for (const std::string& missed : result.missed) {
    line += (line.back() == '[' ? "" : ", ") + quoted(missed);
  }
  line += "], \"rows\": [";
  for (const MishapRow& row : result.rows) {
    line += line.back() == '[' ? "" : ", ";
    line += "{\"at_s\": " + number(row.at_s) + ", \"limbs\": " + quoted(row.limbs) +
            ", \"reaction_ms\": " + number(row.reaction_ms) +
            ", \"back_s\": " + number(row.back_s) + ", \"end\": " + quoted(row.end) + "}";
  }
  return line + "]}";
}

/// Climbs until the mishap came so often. Lines of JSON; empty: something was missed.
bool rehearse(const Arguments& arguments, Mishap mishap) {
  int num_left = arguments.num_times;
  bool good = true;
  for (int i = 0; i < arguments.num_times + kMaxMoreClimbs && num_left > 0; ++i) {
    ClosedLoopParams params =
        params_of(arguments, mishap, arguments.first_seed + static_cast<std::uint64_t>(i));
    params.num_times = num_left;
    ClosedLoop loop(params, runtime::Config::load(arguments.config_files, arguments.overrides));
    const ClosedLoopResult result = loop.run([&](const std::string& line) {
      if (arguments.tells) std::printf("%s\n", line.c_str());
      std::fflush(stdout);
    });
    num_left -= static_cast<int>(result.rows.size());
    good = good && result.missed.empty() && !result.rows.empty();
    std::printf("%-16s seed %llu: %zu times, %zu missed, %d falls, %lld violations\n", name(mishap),
                static_cast<unsigned long long>(params.seed), result.rows.size(),
                result.missed.size(), result.falls, static_cast<long long>(result.num_violations));
    for (const std::string& missed : result.missed) std::printf("  MISSED %s\n", missed.c_str());
    std::fflush(stdout);
    if (!arguments.json_path.empty()) {
      std::ofstream(arguments.json_path, std::ios::app) << json_line(params, result) + "\n";
    }
    if (result.rows.empty()) break;
  }
  return good && num_left <= 0;
}

void parse(CLI::App& app, Arguments& arguments) {
  app.add_option("--mishap", arguments.mishaps, "kill_gng, estop, ...; default all; repeatable")
      ->allow_extra_args(false);
  app.add_option("--times", arguments.num_times, "each")->check(CLI::Range(1, 1000));
  app.add_option("--first-seed", arguments.first_seed, "of ladder, noise and instants");
  app.add_option("--rungs", arguments.num_rungs, "of the ladder")->check(CLI::Range(5, 16));
  app.add_option("--jobs", arguments.num_jobs, "kinds at once; 0 = one per processor");
  app.add_option("--most-pause-s", arguments.most_pause_s, "of climbing between two");
  app.add_option("--json-lines", arguments.json_path, "append one line per climb");
  app.add_option("-c,--config", arguments.config_files, "TOML file; later ones win");
  app.add_option("--set", arguments.overrides, "table.key=value")->allow_extra_args(false);
  app.add_flag("--tell", arguments.tells, "each mishap as it comes");
}

/// Throws std::runtime_error.
std::vector<Mishap> chosen(const Arguments& arguments) {
  std::vector<Mishap> mishaps;
  std::string known;
  for (int i = 0; i < robot_in_a_box::kNumMishaps; ++i) {
    const auto mishap = static_cast<Mishap>(i);
    known += std::string(" ") + name(mishap);
    bool is_wanted = arguments.mishaps.empty();
    for (const std::string& word : arguments.mishaps) is_wanted = is_wanted || word == name(mishap);
    if (is_wanted) mishaps.push_back(mishap);
  }
  const bool is_understood =
      arguments.mishaps.empty() || mishaps.size() >= arguments.mishaps.size();
  if (!is_understood) throw std::runtime_error("--mishap: there are" + known);
  return mishaps;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Mishaps upon the climbing robot, in virtual time.", "ladder_closed_loop");
  Arguments arguments;
  parse(app, arguments);
  CLI11_PARSE(app, argc, argv);
  try {
    runtime::Config::load(arguments.config_files, arguments.overrides);
    bool all_good = true;
    robot_in_a_box::ForkPool pool(arguments.num_jobs);
    for (const Mishap mishap : chosen(arguments)) {
      pool.run([&, mishap] { return rehearse(arguments, mishap) ? "good" : "missed"; },
               [&](bool ended_well, const std::string& told) {
                 all_good = all_good && ended_well && told == "good";
                 if (!ended_well) std::printf("%s: crashed\n", name(mishap));
               });
    }
    pool.finish();
    return all_good ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "ladder_closed_loop: %s\n", error.what());
    return 2;
  }
}
