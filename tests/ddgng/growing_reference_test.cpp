// SPDX-License-Identifier: BSD-3-Clause
// Growing against the literal reference, signal by signal: the same nodes in the same slots, the
// same edges and ages, errors and utilities up to the rounding of lazy decay.
#include <string>

#include <gtest/gtest.h>

#include "../reference/gng_reference.h"
#include "base/rng.h"
#include "ddgng/growing.h"
#include "random_shapes.h"

namespace ddgng {
namespace {

constexpr double kRounding = 1e-4;  // of float sums over a thousand signals

bool in_box(const Eigen::Vector3f& p) {
  return p.x() > 0.5F && p.x() < 1.5F && p.z() < 2.5F;
}

struct Drive {
  GrowingParams params;
  Shape shape = Shape::kUniform;
  std::uint64_t seed = 0;
  int num_signals = 600;
  std::string name;
};

class Pair {
 public:
  explicit Pair(const Drive& run)
      : run_(run), growing_(run.params), reference_(run.params), rng_(run.seed) {
    const Eigen::Vector3f h1 = random_point(run.shape, rng_);
    const Eigen::Vector3f h2 = random_point(run.shape, rng_);
    growing_.start(h1, h2);
    reference_.start(h1, h2);
  }

  /// False when the reference decided by less than float can tell: the two may part from here.
  bool step(int i) {
    const Eigen::Vector3f v = random_point(run_.shape, rng_);
    const Signal signal{v, 0};
    Winners winners;
    growing_.signals({&signal, 1}, &winners);
    reference_.signal(v);
    int removed = -1;
    int reference_removed = -1;
    if (i % run_.params.utility_interval == 0) {
      reference_removed = reference_.remove_useless();
      if (reference_.take_narrowest_lead() < kRounding) return false;
      removed = growing_.remove_useless();
    }
    EXPECT_EQ(removed, reference_removed);
    if (i % run_.params.insertion_interval == 0) {
      if (i % 3 == 0 && !insert(Growing::Weighting::kError, 0)) return false;
      if (!insert(Growing::Weighting::kErrorAndStrength, run_.params.strength_exponent)) {
        return false;
      }
    }
    if (i % 50 == 0) set_strengths();
    return true;
  }

  void compare() const {
    const Graph& graph = growing_.graph();
    ASSERT_EQ(graph.num_nodes(), reference_.num_nodes());
    std::size_t num_halves = 0;
    for (int i = 0; i < static_cast<int>(reference_.nodes().size()); ++i) {
      const reference::Node& node = reference_.nodes()[i];
      ASSERT_EQ(i < graph.num_slots() && graph.alive(i), node.alive) << "slot " << i;
      if (!node.alive) continue;
      ASSERT_EQ(graph.position_m(i), node.h_m) << "slot " << i;
      ASSERT_NEAR(growing_.error_m2(i), node.error, kRounding * node.error) << "slot " << i;
      ASSERT_NEAR(growing_.utility_m2(i), node.utility, kRounding * node.utility) << "slot " << i;
      ASSERT_EQ(growing_.strength(i), static_cast<float>(node.strength)) << "slot " << i;
      for (int k = 0; k < graph.degree(i); ++k) {
        const reference::Edge* edge = reference_.edge(i, graph.neighbours(i)[k]);
        ASSERT_NE(edge, nullptr) << "slot " << i;
        ASSERT_EQ(graph.age(i, k), edge->age) << "slot " << i;
        ++num_halves;
      }
    }
    ASSERT_EQ(num_halves, 2 * reference_.edges().size());
  }

 private:
  bool insert(Growing::Weighting weighting, int exponent) {
    const int expected = reference_.insert(exponent, in_box);
    if (reference_.take_narrowest_lead() < kRounding) return false;
    const int slot = growing_.insert(weighting);
    EXPECT_EQ(slot, expected);
    if (slot >= 0) growing_.set_inside(slot, in_box(growing_.graph().position_m(slot)));
    return true;
  }

  void set_strengths() {
    reference_.set_strengths(in_box);
    for (int slot = 0; slot < growing_.graph().num_slots(); ++slot) {
      if (!growing_.graph().alive(slot)) continue;
      growing_.set_inside(slot, in_box(growing_.graph().position_m(slot)));
    }
  }

  Drive run_;
  Growing growing_;
  reference::Gng reference_;
  base::Rng rng_;
};

class GrowingReference : public testing::TestWithParam<Drive> {};

// Every state after every signal agrees, over twenty seeds; a seed ends early where the reference
// itself decided by less than the rounding, and enough signals must have been compared.
TEST_P(GrowingReference, SameStateAfterEverySignal) {
  int num_compared = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Drive run = GetParam();
    run.seed = seed;
    Pair pair(run);
    for (int i = 1; i <= run.num_signals && pair.step(i); ++i) {
      pair.compare();
      if (HasFatalFailure()) FAIL() << "seed " << seed << ", signal " << i;
      ++num_compared;
    }
  }
  EXPECT_GE(num_compared, 200);
  RecordProperty("signals_compared", num_compared);
}

GrowingParams small(GrowingParams params, int max_nodes, int max_degree) {
  params.max_nodes = max_nodes;
  params.max_plane_nodes = max_nodes;
  params.max_boot_nodes = max_nodes;
  params.max_degree = max_degree;
  return params;
}

std::vector<Drive> runs() {
  GrowingParams paper = paper_params();
  paper.insertion_interval = 7;  // more happens in a short test
  GrowingParams busy;            // edges and nodes die all the time
  busy.max_edge_age = 5;
  busy.utility_threshold = 3.0F;
  busy.utility_interval = 2;
  busy.insertion_interval = 3;
  GrowingParams two_decays = busy;
  two_decays.utility_decay_outside = 0.05F;
  two_decays.utility_decay_inside = 0.01F;
  two_decays.error_decay = 0.1F;  // the shared scale shrinks within a run
  std::vector<Drive> list;
  const char* const names[] = {"Uniform",   "Clusters", "Duplicates",
                               "Collinear", "Lattice",  "Identical"};
  for (int s = 0; s < 6; ++s) {
    const auto add = [&](const GrowingParams& params, const char* name) {
      list.push_back({params, kShapes[s], 0, 600, std::string(name) + names[s]});
    };
    add(small({}, 100, 24), "Default");
    add(small(paper, 100, 24), "Paper");
    add(small(busy, 60, 24), "Busy");
    add(small(two_decays, 60, 24), "TwoDecays");
    add(small(busy, 60, 3), "LowDegree");
    add(small(busy, 2, 2), "TwoNodes");
    add(small(busy, 3, 2), "ThreeNodes");
  }
  return list;
}

INSTANTIATE_TEST_SUITE_P(Drives, GrowingReference, testing::ValuesIn(runs()),
                         [](const auto& run) { return run.param.name; });

}  // namespace
}  // namespace ddgng
