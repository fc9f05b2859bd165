// SPDX-License-Identifier: BSD-3-Clause
#include "robot_in_a_box/drill.h"

#include <algorithm>
#include <cstring>
#include <memory>
#include <optional>

#include "robot_in_a_box/drill_tables.h"
#include "robot_in_a_box/fork_pool.h"

namespace robot_in_a_box {
namespace {

std::uint64_t case_seed(std::uint64_t seed, std::size_t row, std::int64_t cycle, int target) {
  const auto place = static_cast<std::uint64_t>(cycle) * 64 + static_cast<std::uint64_t>(target);
  return base::Rng(seed + 1000 * row, place).next();
}

std::string row_name(const DrillRow& row) {
  return std::to_string(row.number) + row.part;
}

std::string case_name(const DrillRow& row, TourKind tour, std::int64_t cycle, int target) {
  return row_name(row) + "@" + name(tour) + ":" + std::to_string(cycle) + ":" +
         std::to_string(target);
}

std::string bytes_of(const CaseResult& result) {
  std::string bytes(sizeof(result), '\0');
  std::memcpy(bytes.data(), &result, sizeof(result));
  return bytes;
}

CaseResult result_from(bool ended_well, const std::string& bytes) {
  CaseResult result;
  if (ended_well && bytes.size() == sizeof(result)) {
    std::memcpy(&result, bytes.data(), sizeof(result));
  } else {
    result.visible = true;
    std::strncpy(result.why.data(), "the program crashed", result.why.size() - 1);
  }
  return result;
}

void count(const CaseResult& result, const std::string& what, std::size_t num_told,
           RowScore& score) {
  if (!result.visible && result.why[0] == '\0') {
    ++score.unseen;
    return;
  }
  ++score.cases;
  score.worst_us = std::max(score.worst_us, result.reaction_us);
  if (result.met) return;
  ++score.missed;
  if (score.misses.size() < num_told) {
    score.misses.push_back(what + ": " + result.why.data());
  }
}

/// A box on its tour, cycle by cycle.
struct Journey {
  Journey(TourKind kind, std::uint64_t seed) : box(tour_params(kind, seed)), tour(kind, box) {}
  bool next() {
    tour.act();
    if (tour.is_over()) return false;
    box.cycle();
    ++cycle;
    return true;
  }
  ClimbBox box;
  Tour tour;
  std::int64_t cycle = 0;
};

}  // namespace

std::span<const DrillRow> drill_rows() {
  static const std::vector<DrillRow> all = [] {
    std::vector<DrillRow> rows;
    for (const auto part : {rows_of_messages(), rows_of_grasps(), rows_of_drives(),
                            rows_of_process(), rows_of_senses()}) {
      rows.insert(rows.end(), part.begin(), part.end());
    }
    std::stable_sort(rows.begin(), rows.end(),
                     [](const DrillRow& a, const DrillRow& b) { return a.number < b.number; });
    return rows;
  }();
  return all;
}

DrillScore run_drill(const DrillOptions& options) {
  DrillScore score;
  for (const DrillRow& row : drill_rows()) score.rows.push_back({&row, 0, 0, 0, -1, {}});
  ForkPool pool(options.num_jobs);
  std::set<Situation> seen;
  for (int kind = 0; kind < kNumTourKinds; ++kind) {
    const auto tour = static_cast<TourKind>(kind);
    if (!options.tours.empty() && options.tours.count(tour) == 0) continue;
    Journey journey(tour, options.seed);
    while (journey.next()) {
      const Situation now = situation_of(journey.box);
      // A support lost a moment ago is about to stop everything for its own reason.
      const bool is_passing = now.limb == climb::LimbState::kSupportLost && is_powered(now.state);
      if (is_passing || !seen.insert(now).second) continue;
      if (++score.num_situations % options.every != 0) continue;
      for (std::size_t i = 0; i < score.rows.size(); ++i) {
        const DrillRow& row = drill_rows()[i];
        const bool wanted = options.rows.empty() || options.rows.count(row.number) > 0;
        if (!wanted || !row.applies(now)) continue;
        for (int target = 0; target < row.num_targets; ++target) {
          const std::uint64_t seed = case_seed(options.seed, i, journey.cycle, target);
          const std::string what =
              case_name(row, tour, journey.cycle, target) + " (" + describe(now) + ")";
          pool.run([&] { return bytes_of(CaseRun(journey.box, row, target, seed).run()); },
                   [&score, &options, i, what](bool ended_well, const std::string& bytes) {
                     count(result_from(ended_well, bytes), what, options.num_misses_told,
                           score.rows[i]);
                   });
        }
      }
    }
  }
  pool.finish();
  return score;
}

namespace {

/// Passes everything on to a case and tells what changes.
class Teller : public BoxWatcher {
 public:
  Teller(CaseRun& run, const std::function<void(const std::string&)>& tell)
      : run_(run), tell_(tell) {}
  void before(std::int64_t now_us) override {
    const bool was = run_.injected_us() >= 0;
    run_.before(now_us);
    if (!was && run_.injected_us() >= 0) say("injected");
  }
  void on_frame(const simulator::CarriedFrame& carried) override { run_.on_frame(carried); }
  void on_truth(const simulator::PlantTruth& truth) override {
    run_.on_truth(truth);
    say_change();
  }
  void on_report(const climb_controller::CycleReport& report) override {
    run_.on_report(report);
    say_change();
  }

 private:
  void say(const std::string& what) {
    tell_(std::to_string(run_.now_us() / 1000) + " ms  " + what);
  }
  void say_change() {
    std::string now = describe(situation_of(run_.box()));
    now += std::string(", reason ") + climb::name(run_.reason());
    now += std::string(", bus ") + can::name(run_.report().bus_phase);
    if (run_.visible_us() >= 0) now += ", visible";
    if (run_.reacted_us() >= 0) now += ", reacted";
    if (run_.truth().fallen) now += ", fallen";
    if (now != last_) say(now);
    last_ = now;
  }

  CaseRun& run_;
  const std::function<void(const std::string&)>& tell_;
  std::string last_;
};

}  // namespace

bool replay_case(const std::string& wanted, std::uint64_t seed,
                 const std::function<void(const std::string& line)>& tell) {
  for (int kind = 0; kind < kNumTourKinds; ++kind) {
    const auto tour = static_cast<TourKind>(kind);
    if (wanted.find(std::string("@") + name(tour) + ":") == std::string::npos) continue;
    Journey journey(tour, seed);
    while (journey.next()) {
      for (std::size_t i = 0; i < drill_rows().size(); ++i) {
        const DrillRow& row = drill_rows()[i];
        for (int target = 0; target < row.num_targets; ++target) {
          if (case_name(row, tour, journey.cycle, target) != wanted) continue;
          CaseRun run(journey.box, row, target, case_seed(seed, i, journey.cycle, target));
          Teller teller(run, tell);
          const CaseResult result = run.run(&teller);
          tell(result.met ? "met" : std::string("missed: ") + result.why.data());
          return true;
        }
      }
    }
  }
  return false;
}

}  // namespace robot_in_a_box
