// SPDX-License-Identifier: BSD-3-Clause
// ladder_climbs: whole climbs in full fidelity and virtual time, several at once in forked copies.
// A seed says everything. Writes what came of each as one JSON line. Behind scripts/climbs.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <lcm/lcm-cpp.hpp>

#include "robot_in_a_box/byte_hash.h"
#include "robot_in_a_box/fork_pool.h"
#include "robot_in_a_box/full_climb.h"

namespace {

using robot_in_a_box::ByteHash;
using robot_in_a_box::ClimbEnd;
using robot_in_a_box::FullClimb;
using robot_in_a_box::FullClimbParams;

struct Arguments {
  int num_plain = 0;
  int num_damaged = 0;
  std::uint64_t first_seed = 1;
  int num_rungs = 13;
  int num_jobs = 0;
  double max_s = 900.0;
  std::string json_path;
  std::string log_path;
  double log_s = 0.0;
  bool logs_inputs_only = false;
  std::vector<std::string> config_files;
  std::vector<std::string> overrides;
  bool down = false;
  bool trace = false;
};

/// What is wrong with a ladder.
constexpr std::array<const char*, 6> kDamages = {"plain",  "missing", "bent",
                                                 "broken", "loose",   "weak"};

struct Task {
  std::uint64_t seed = 1;
  bool damaged = false;
  std::string damage = "plain";
  FullClimbParams params;
};

/// Damaged ones take the kinds in turn; a loose rung comes off when a claw loads it, a weak one
/// bears a hanging limb and breaks in the pull test or later.
Task task_of(const Arguments& arguments, std::uint64_t seed, bool damaged) {
  Task task;
  base::Rng rng(seed, damaged ? 12 : 11);
  task.seed = seed;
  task.damaged = damaged;
  if (damaged) task.damage = kDamages[1 + seed % (kDamages.size() - 1)];
  simulator::SceneParams& scene = task.params.climb.scene;
  scene.seed = seed;
  scene.num_rungs = arguments.num_rungs;
  scene.spacing_m = damaged ? 0.25 + 0.10 * rng.uniform() : 0.30;
  const int rung =
      4 +
      static_cast<int>(rng.below(static_cast<std::uint32_t>(std::max(1, arguments.num_rungs - 6))));
  if (task.damage == "missing") scene.kind = simulator::SceneKind::kMissing;
  if (task.damage == "bent") scene.kind = simulator::SceneKind::kBent;
  if (task.damage == "broken") scene.kind = simulator::SceneKind::kBroken;
  if (scene.kind != simulator::SceneKind::kPlain) scene.damaged_rung = rung;
  if (task.damage == "loose") task.params.climb.weak_rungs.push_back({rung, 5.0});
  if (task.damage == "weak") {
    task.params.climb.weak_rungs.push_back({rung, 40.0 + 40.0 * rng.uniform()});
  }
  task.params.climb.seed = seed;
  task.params.perception.heads.seed = seed;
  return task;
}

/// One way, up or down.
struct Way {
  ClimbEnd end = ClimbEnd::kFault;
  std::string reason;
};

std::string json_of(const char* key, const char* reason_key, const Way& way) {
  return std::string("\"") + key + "\": \"" + name(way.end) + "\", \"" + reason_key + "\": \"" +
         way.reason + "\", ";
}

std::string json_line(const Task& task, const Way& up, const std::optional<Way>& down,
                      FullClimb& full, double wall_s) {
  char ladder[200];
  std::snprintf(ladder, sizeof ladder,
                "{\"seed\": %llu, \"damage\": \"%s\", \"rungs\": %d, \"spacing_m\": %.3f, ",
                static_cast<unsigned long long>(task.seed), task.damage.c_str(),
                task.params.climb.scene.num_rungs, task.params.climb.scene.spacing_m);
  char last[80];
  std::snprintf(last, sizeof last, ", \"violations\": %zu, \"wall_s\": %.1f}",
                full.climb().box().monitor().violations().size(), wall_s);
  const std::string downwards = down ? json_of("down", "down_reason", *down) : "";
  return ladder + json_of("end", "reason", up) + downwards +
         simulator::json_members(full.climb().figures()) + last;
}

std::string crashed_line(const Task& task) {
  return "{\"seed\": " + std::to_string(task.seed) + ", \"damage\": \"" + task.damage +
         "\", \"rungs\": " + std::to_string(task.params.climb.scene.num_rungs) +
         ", \"end\": \"crashed\"}";
}

std::string hash_in_json(const ByteHash& made) {
  char text[100];
  std::snprintf(text, sizeof text, ", \"made\": \"%lld messages, hash %016llx\"",
                static_cast<long long>(made.num_messages()),
                static_cast<unsigned long long>(made.value()));
  return text;
}

bool is_made_by_perception(std::string_view channel) {
  return channel == "LADDER_CLOUD" || channel == "LADDER_TOPOLOGY" || channel == "LADDER_RUNGS";
}

/// Every message of the climb into an LCM log, up to log_s; what perception makes of them is
/// hashed, so that a replay of the log can be compared.
void log_into(lcm::LogFile& log, const Arguments& arguments, FullClimb& full, ByteHash& made) {
  full.eyes().log_to(
      [&](const char* channel, const void* bytes, std::size_t num_bytes, std::int64_t utime_us) {
        const double now_s = 1e-6 * static_cast<double>(full.climb().box().now_us());
        if (arguments.log_s > 0.0 && now_s > arguments.log_s) return;
        const bool is_made = is_made_by_perception(channel);
        if (is_made) made.add(channel, bytes, num_bytes);
        if (is_made && arguments.logs_inputs_only) return;
        lcm::LogEvent event{};
        event.timestamp = utime_us;
        event.channel = channel;
        event.data = const_cast<void*>(bytes);  // NOLINT: LCM's structure has no const
        event.datalen = static_cast<std::int32_t>(num_bytes);
        log.writeEvent(&event);
      });
}

/// What is wrong with it: "!" damaged, "?" not trusted, "-" nothing of it is offered.
const char* mark_of(const climb::LadderView& view, int rung_index) {
  const climb::RungView& rung = view.rungs[rung_index];
  if (rung.damaged) return "!";
  if (!rung.trusted) return "?";
  const bool is_offered = std::any_of(
      view.stretches.begin(), view.stretches.end(),
      [&](const climb::StretchView& stretch) { return stretch.rung_index == rung_index; });
  return is_offered ? "" : "-";
}

void trace(FullClimb& full) {
  const robot_in_a_box::ClimbBox& box = full.climb().box();
  const climb::ControllerOutput& out = box.report().output;
  std::printf("%7.1f s %-15s %-16s %-22s z %.3f m", 1e-6 * static_cast<double>(box.now_us()),
              climb::name(out.state), climb::name(out.reason), climb::name(out.refusal),
              full.climb().height_m());
  for (const climb::Leg leg : climb::kLegs) {
    std::printf("  %s:%d", climb::name(out.limbs[leg]), box.plant().leg(leg).rung_index);
  }
  const climb::LadderView view = full.eyes().view();
  std::printf("  %s", view.confirmed ? "ladder:" : "no ladder:");
  for (int i = 0; i < static_cast<int>(view.rungs.size()); ++i) {
    const climb::RungView& rung = view.rungs[i];
    std::printf(" %.2f/%.0f%s", rung.end0_m.z(), 1e3 * rung.radius_m, mark_of(view, i));
  }
  std::printf("\n");
  std::fflush(stdout);
}

std::string run(const Arguments& arguments, const Task& task) {
  const auto begin = std::chrono::steady_clock::now();
  FullClimb full(task.params, runtime::Config::load(arguments.config_files, arguments.overrides));
  std::optional<lcm::LogFile> log;
  ByteHash made;
  if (!arguments.log_path.empty()) {
    log.emplace(arguments.log_path, "w");
    log_into(*log, arguments, full, made);
  }
  if (arguments.trace) full.climb().each_second([&full] { trace(full); });
  full.climb().run_s(3.0);
  Way up;
  if (full.climb().hang()) up.end = full.climb().climb(true, arguments.max_s);
  up.reason = full.climb().reason();
  std::optional<Way> down;
  if (arguments.down && up.end == ClimbEnd::kTop) {
    down = Way{full.climb().climb(false, arguments.max_s), ""};
    if (down->end == ClimbEnd::kDock && !full.climb().back_into_dock()) down->end = ClimbEnd::kHeld;
    down->reason = full.climb().reason();
  }
  const double wall_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::string line = json_line(task, up, down, full, wall_s);
  if (log) line.insert(line.size() - 1, hash_in_json(made));
  return line;
}

void parse(CLI::App& app, Arguments& arguments) {
  app.add_option("--plain", arguments.num_plain, "so many plain ladders");
  app.add_option("--damaged", arguments.num_damaged, "so many damaged ones");
  app.add_option("--first-seed", arguments.first_seed, "of either sort");
  app.add_option("--rungs", arguments.num_rungs, "of each ladder")->check(CLI::Range(4, 16));
  app.add_option("--jobs", arguments.num_jobs, "climbs at once; 0 = one per processor");
  app.add_option("--max-s", arguments.max_s, "simulated seconds, then a climb is given up");
  app.add_option("--json-lines", arguments.json_path, "append one line per climb");
  app.add_option("--log", arguments.log_path, "every message of the last climb, as an LCM log");
  app.add_option("--log-s", arguments.log_s, "only up to this simulated time");
  app.add_flag("--log-inputs", arguments.logs_inputs_only, "only what ladder_replay reads");
  app.add_option("-c,--config", arguments.config_files, "TOML file; later ones win");
  app.add_option("--set", arguments.overrides, "table.key=value")->allow_extra_args(false);
  app.add_flag("--down", arguments.down, "from the top back into the dock, and disarm");
  app.add_flag("--trace", arguments.trace, "one line per simulated second");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Climbs of the whole robot in virtual time.", "ladder_climbs");
  Arguments arguments;
  parse(app, arguments);
  CLI11_PARSE(app, argc, argv);
  std::ofstream lines(arguments.json_path, std::ios::app);
  const auto tell = [&lines](const std::string& line) {
    std::printf("%s\n", line.c_str());
    std::fflush(stdout);
    if (lines) lines << line << std::endl;
  };
  try {
    runtime::Config::load(arguments.config_files, arguments.overrides);
    robot_in_a_box::ForkPool pool(arguments.num_jobs);
    for (int i = 0; i < arguments.num_plain + arguments.num_damaged; ++i) {
      const bool damaged = i >= arguments.num_plain;
      const int index = damaged ? i - arguments.num_plain : i;
      const Task task =
          task_of(arguments, arguments.first_seed + static_cast<std::uint64_t>(index), damaged);
      pool.run([&arguments, task] { return run(arguments, task); },
               [tell, task](bool ended_well, const std::string& line) {
                 tell(ended_well ? line : crashed_line(task));
               });
    }
    pool.finish();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "ladder_climbs: %s\n", error.what());
    return 2;
  }
}
