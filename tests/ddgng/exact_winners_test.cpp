// SPDX-License-Identifier: BSD-3-Clause
// Every signal of a growing graph has the winners that a search of every node finds, ties included:
// two graphs learn side by side, one with cells and with the search that runs ahead, one with
// neither. LADDER_NUM_QUERIES sets how many signals each instruction set gets (the full check:
// 1e7).
#include <array>
#include <cstdlib>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "base/rng.h"
#include "ddgng/growing.h"
#include "random_shapes.h"

namespace ddgng {
namespace {

constexpr int kRun = 10;

int num_queries() {
  const char* const asked = std::getenv("LADDER_NUM_QUERIES");
  return asked != nullptr ? std::atoi(asked) : 100'000;
}

struct Scene {
  std::string name;
  Shape shape = Shape::kUniform;
  bool uneven = false;  // half of the signals from a hundredth of the space
  int max_nodes = 300;
  float winner_rate = 0.05F;
};

std::vector<Scene> scenes() {
  return {{"Uniform", Shape::kUniform, false, 300, 0.05F},
          {"Uneven", Shape::kUniform, true, 1500, 0.05F},
          {"UnevenFast", Shape::kUniform, true, 600, 0.5F},
          {"Clusters", Shape::kClusters, false, 300, 0.05F},
          {"Duplicates", Shape::kDuplicates, false, 100, 0.0F},
          {"Collinear", Shape::kCollinear, false, 300, 0.05F},
          {"Lattice", Shape::kLattice, false, 200, 0.0F},
          {"LatticeMoving", Shape::kLattice, false, 200, 0.5F},
          {"Identical", Shape::kIdentical, false, 50, 0.08F},
          {"TwoNodes", Shape::kUniform, false, 2, 0.05F}};
}

bool in_box(const Eigen::Vector3f& p) {
  return p.x() > 1.0F && p.x() < 1.8F && p.y() > -2.0F && p.y() < 2.0F;
}

Eigen::Vector3f draw(const Scene& scene, base::Rng& rng) {
  Eigen::Vector3f p = random_point(scene.shape, rng);
  if (scene.uneven && rng.below(2) == 0) {
    p = {1.0F + 0.2F * p.x(), 0.1F * p.y(), 0.02F * p.z()};
  }
  return p;
}

GrowingParams params_of(const Scene& scene) {
  GrowingParams params;
  params.max_nodes = params.max_plane_nodes = params.max_boot_nodes = scene.max_nodes;
  params.winner_rate = scene.winner_rate;
  params.neighbour_rate = 0.1F * scene.winner_rate;
  params.utility_threshold = 200.0F;
  return params;
}

class SideBySide {
 public:
  SideBySide(const Scene& scene, std::uint64_t seed)
      : scene_(scene), rng_(seed), cells_(params_of(scene)), linear_(params_of(scene)) {
    const Eigen::Vector3f h1 = draw(scene, rng_);
    const Eigen::Vector3f h2 = draw(scene, rng_);
    linear_.search_linearly();
    cells_.start(h1, h2);
    linear_.start(h1, h2);
  }

  void run() {
    std::array<Signal, kRun> signals;
    for (Signal& signal : signals) signal = {draw(scene_, rng_), 0};
    std::array<Winners, kRun> found;
    std::array<Winners, kRun> expected;
    cells_.signals(signals, found.data());
    linear_.signals(signals, expected.data());
    for (int i = 0; i < kRun; ++i) {
      ASSERT_EQ(found[i].first, expected[i].first);
      ASSERT_EQ(found[i].second, expected[i].second);
      ASSERT_EQ(found[i].first_m2, expected[i].first_m2);
      ASSERT_EQ(found[i].second_m2, expected[i].second_m2);
    }
    ASSERT_EQ(cells_.remove_useless(), linear_.remove_useless());
    const int slot = cells_.insert(Growing::Weighting::kErrorAndStrength);
    ASSERT_EQ(slot, linear_.insert(Growing::Weighting::kErrorAndStrength));
    if (slot >= 0) set_inside(slot);
    if (++num_runs_ % 100 == 0) {
      for (int i = 0; i < cells_.graph().num_slots(); ++i) {
        if (cells_.graph().alive(i)) set_inside(i);
      }
    }
  }

  const WinnerSearch::Counts& counts() const { return cells_.search_counts(); }

 private:
  void set_inside(int slot) {
    const bool inside = in_box(cells_.graph().position_m(slot));
    cells_.set_inside(slot, inside);
    linear_.set_inside(slot, inside);
  }

  Scene scene_;
  base::Rng rng_;
  Growing cells_, linear_;
  int num_runs_ = 0;
};

class ExactWinners : public testing::TestWithParam<std::int64_t> {
 protected:
  void SetUp() override { hwy::SetSupportedTargetsForTest(GetParam()); }
  void TearDown() override { hwy::SetSupportedTargetsForTest(0); }
};

// Uneven, clustered, collinear and duplicate places, standing and moving: the winners are equal at
// every signal, and where nodes are spread most searches need cells alone.
TEST_P(ExactWinners, EqualTheLinearSearch) {
  const std::vector<Scene> all = scenes();
  std::uint64_t seed = 1;
  for (const Scene& scene : all) {
    SCOPED_TRACE(scene.name);
    SideBySide pair(scene, seed++);
    const int num_runs = num_queries() / static_cast<int>(all.size()) / kRun;
    for (int i = 0; i < num_runs; ++i) {
      pair.run();
      if (HasFatalFailure()) return;
    }
    if (scene.uneven) {
      EXPECT_LT(pair.counts().linear, pair.counts().searches / 4);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AllTargets, ExactWinners,
                         testing::ValuesIn(hwy::SupportedAndGeneratedTargets()),
                         [](const auto& target) {
                           return std::string(hwy::TargetName(target.param));
                         });

}  // namespace
}  // namespace ddgng
