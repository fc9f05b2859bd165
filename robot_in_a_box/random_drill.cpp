// SPDX-License-Identifier: BSD-3-Clause
#include "robot_in_a_box/random_drill.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "robot_in_a_box/drill.h"
#include "robot_in_a_box/drill_tables.h"
#include "robot_in_a_box/fork_pool.h"

namespace robot_in_a_box {
namespace {

constexpr int kNumCycles = 550;
constexpr int kNumQuietCycles = 100;  ///< at the end nothing new begins
constexpr std::uint64_t kTourSeed = 1;

/// Tours that random troubles branch off from, and how many of their cycles are used.
struct Branch {
  TourKind kind;
  std::uint32_t num_cycles;
};
constexpr std::array<Branch, 7> kBranches = {{{TourKind::kClimb, 7'000},
                                              {TourKind::kPauses, 12'000},
                                              {TourKind::kSilences, 12'000},
                                              {TourKind::kMisses, 10'000},
                                              {TourKind::kWithdrawals, 9'000},
                                              {TourKind::kStops, 20'000},
                                              {TourKind::kEstops, 20'000}}};

struct Place {
  std::size_t branch = 0;
  std::int64_t cycle = 0;
  std::uint64_t seed = 0;
  std::size_t index = 0;
};

std::vector<Place> places(std::uint64_t first_seed, int num_seeds) {
  std::vector<Place> all;
  for (int i = 0; i < num_seeds; ++i) {
    const std::uint64_t seed = first_seed + static_cast<std::uint64_t>(i);
    base::Rng rng(seed, 1);
    const std::size_t branch = rng.below(static_cast<std::uint32_t>(kBranches.size()));
    all.push_back(
        {branch, rng.below(kBranches[branch].num_cycles), seed, static_cast<std::size_t>(i)});
  }
  std::sort(all.begin(), all.end(), [](const Place& a, const Place& b) {
    return std::tuple(a.branch, a.cycle, a.seed) < std::tuple(b.branch, b.cycle, b.seed);
  });
  return all;
}

/// What a copy hands back, as bytes.
struct Outcome {
  std::uint64_t frame_hash = 0;
  std::int64_t num_targets = 0;
  std::int64_t num_violations = 0;
  std::array<char, 200> first_violation{};
};

void live_through(ClimbBox& box, std::uint64_t seed, const Tell& tell) {
  Trouble trouble(box, seed, {}, tell);
  box.watch(&trouble);
  for (int i = 0; i < kNumCycles; ++i) {
    trouble.act(i < kNumCycles - kNumQuietCycles);
    box.cycle();
  }
  box.watch(nullptr);
}

std::string outcome_of(const ClimbBox& box) {
  Outcome outcome{
      box.frame_hash(), box.monitor().num_targets(), box.monitor().num_violations(), {}};
  if (!box.monitor().violations().empty()) {
    const std::string text = describe(box.monitor().violations().front());
    std::strncpy(outcome.first_violation.data(), text.c_str(), outcome.first_violation.size() - 1);
  }
  return {reinterpret_cast<const char*>(&outcome), sizeof(outcome)};
}

void take_outcome(bool ended_well, const std::string& bytes, SeedResult& result) {
  Outcome outcome;
  if (!ended_well || bytes.size() != sizeof(outcome)) {
    result.num_violations = 1;
    result.first_violation = "the program crashed";
    return;
  }
  std::memcpy(&outcome, bytes.data(), sizeof(outcome));
  result.frame_hash = outcome.frame_hash;
  result.num_targets = outcome.num_targets;
  result.num_violations = outcome.num_violations;
  result.first_violation = outcome.first_violation.data();
}

/// Calls `at` in each place, in turn, with a box that has come there on its tour.
template <class At>
void visit(const std::vector<Place>& sorted, At at) {
  for (std::size_t next = 0; next < sorted.size();) {
    const std::size_t branch = sorted[next].branch;
    const TourKind kind = kBranches[branch].kind;
    ClimbBox box(tour_params(kind, kTourSeed));
    Tour tour(kind, box);
    for (std::int64_t cycle = 0; next < sorted.size() && sorted[next].branch == branch; ++cycle) {
      for (; next < sorted.size() && sorted[next].branch == branch && sorted[next].cycle <= cycle;
           ++next) {
        at(sorted[next], box);
      }
      if (!tour.is_over()) tour.act();
      box.cycle();
    }
  }
}

}  // namespace

std::vector<SeedResult> run_random(std::uint64_t first_seed, int num_seeds, int num_jobs) {
  std::vector<SeedResult> results(static_cast<std::size_t>(num_seeds));
  ForkPool pool(num_jobs);
  visit(places(first_seed, num_seeds), [&](const Place& place, ClimbBox& box) {
    SeedResult& result = results[place.index];
    result.seed = place.seed;
    result.situation = describe(situation_of(box));
    pool.run(
        [&] {
          live_through(box, place.seed, {});
          return outcome_of(box);
        },
        [&result](bool ended_well, const std::string& bytes) {
          take_outcome(ended_well, bytes, result);
        });
  });
  pool.finish();
  return results;
}

void tell_seed(std::uint64_t seed, const Tell& tell) {
  visit(places(seed, 1), [&](const Place& place, ClimbBox& box) {
    tell("seed " + std::to_string(seed) + ": " + describe(situation_of(box)));
    live_through(box, place.seed, tell);
  });
}

KillScore run_kills(std::uint64_t seed, int num_kills, int num_jobs) {
  const auto rows = rows_of_process();
  const auto row = std::find_if(rows.begin(), rows.end(),
                                [](const DrillRow& each) { return each.number == 20; });
  KillScore score;
  ForkPool pool(num_jobs);
  // Not every instant has drives that follow targets: so many more are looked at.
  visit(places(seed * 1'000'003, 4 * num_kills), [&](const Place& place, ClimbBox& box) {
    if (score.kills >= num_kills || !row->applies(situation_of(box))) return;
    ++score.kills;
    const std::string what = "seed " + std::to_string(place.seed);
    pool.run(
        [&] {
          const CaseResult result = CaseRun(box, *row, 0, place.seed).run();
          return std::string(reinterpret_cast<const char*>(&result), sizeof(result));
        },
        [&score, what](bool ended_well, const std::string& bytes) {
          CaseResult result;
          if (ended_well) std::memcpy(&result, bytes.data(), sizeof(result));
          score.worst_us = std::max(score.worst_us, result.reaction_us);
          if (ended_well && (result.met || !result.visible)) return;
          ++score.missed;
          score.misses.push_back(what + ": " + result.why.data());
        });
  });
  pool.finish();
  return score;
}

}  // namespace robot_in_a_box
