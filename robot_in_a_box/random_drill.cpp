// SPDX-License-Identifier: BSD-3-Clause
#include "robot_in_a_box/random_drill.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "robot_in_a_box/drill.h"
#include "robot_in_a_box/drill_tables.h"
#include "robot_in_a_box/fork_pool.h"
#include "simulator/plant/fault_script.h"

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

/// Faults of the plant by script; orders, sensors and the process by chance.
class Trouble : public BoxWatcher {
 public:
  Trouble(ClimbBox& box, std::uint64_t seed)
      : box_(box), rng_(seed, 2), player_(script(seed, box), box.bus()) {}

  void before(std::int64_t now_us) override { player_.apply(now_us, box_.plant(), box_.bus()); }
  void on_frame(const simulator::CarriedFrame&) override {}
  void on_truth(const simulator::PlantTruth&) override {}
  void on_report(const climb_controller::CycleReport&) override {}

  /// Before each cycle.
  void act(bool may_begin) {
    if (rng_.below(60) == 0) give_order();
    box_.imu_silent = box_.imu_silent && rng_.below(20) != 0;
    box_.perception().silent = box_.perception().silent && rng_.below(40) != 0;
    if (rng_.below(50) == 0) box_.perception().nonsense = Nonsense::kNone;
    if (!may_begin || rng_.below(150) != 0) return;
    switch (rng_.below(6)) {
      case 0:
        return box_.hang(5'000 * (1 + rng_.below(60)));
      case 1:
        box_.imu_silent = true;
        return;
      case 2:
        box_.perception().silent = true;
        return;
      case 3:
        box_.perception().nonsense = static_cast<Nonsense>(1 + rng_.below(7));
        return;
      case 4:
        return box_.sleep(100'000 * (1 + rng_.below(100)));
      default:
        box_.perception().withdrawn_rung = static_cast<int>(rng_.below(9));
    }
  }

 private:
  static std::vector<simulator::Fault> script(std::uint64_t seed, const ClimbBox& box) {
    base::Rng rng(seed, 3);
    simulator::RandomFaultParams random;
    random.num_faults = 1 + static_cast<int>(rng.below(4));
    random.from_us = box.now_us();
    random.until_us = box.now_us() + 4'000'000;
    random.num_rungs = box.plant().world().num_rungs();
    return simulator::random_faults(rng.next(), random);
  }
  void give_order() {
    using climb::Order;
    constexpr std::array<Order, 8> kOrders = {Order::kArm,   Order::kClimb, Order::kClimb,
                                              Order::kPause, Order::kHold,  Order::kReset,
                                              Order::kReset, Order::kArm};
    box_.order(kOrders[rng_.below(8)]);
  }

  ClimbBox& box_;
  base::Rng rng_;
  simulator::FaultPlayer player_;
};

/// What a copy hands back, as bytes.
struct Outcome {
  std::uint64_t frame_hash = 0;
  std::int64_t num_targets = 0;
  std::int64_t num_violations = 0;
  std::array<char, 200> first_violation{};
};

std::string live_through(ClimbBox& box, std::uint64_t seed) {
  Trouble trouble(box, seed);
  box.watch(&trouble);
  for (int i = 0; i < kNumCycles; ++i) {
    trouble.act(i < kNumCycles - kNumQuietCycles);
    box.cycle();
  }
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
    pool.run([&] { return live_through(box, place.seed); },
             [&result](bool ended_well, const std::string& bytes) {
               take_outcome(ended_well, bytes, result);
             });
  });
  pool.finish();
  return results;
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
