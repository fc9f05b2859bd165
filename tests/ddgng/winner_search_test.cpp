// SPDX-License-Identifier: BSD-3-Clause
// The winner search against a loop over all nodes: same slots, same bits, on every instruction set
// that this machine offers.
#include "ddgng/winner_search.h"

#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "base/rng.h"
#include "random_shapes.h"

namespace ddgng {
namespace {

Winners brute_force(const Graph& graph, const Eigen::Vector3f& v) {
  constexpr float kMax = std::numeric_limits<float>::max();
  Winners winners{-1, -1, kMax, kMax};
  for (int i = 0; i < graph.num_slots(); ++i) {
    if (!graph.alive(i)) continue;
    const Eigen::Vector3f d = graph.position_m(i) - v;
    const float m2 = d.x() * d.x() + d.y() * d.y() + d.z() * d.z();
    if (m2 < winners.first_m2) {
      winners.second = winners.first;
      winners.second_m2 = winners.first_m2;
      winners.first = i;
      winners.first_m2 = m2;
    } else if (m2 < winners.second_m2) {
      winners.second = i;
      winners.second_m2 = m2;
    }
  }
  return winners;
}

Graph random_graph(Shape shape, int num_nodes, base::Rng& rng) {
  Graph graph(num_nodes + 8, 4);
  for (int i = 0; i < num_nodes + 8; ++i) graph.add_node(random_point(shape, rng));
  while (graph.num_nodes() > num_nodes) {  // holes
    const auto slot = static_cast<int>(rng.below(static_cast<std::uint32_t>(num_nodes + 8)));
    if (graph.alive(slot)) graph.remove_node(slot);
  }
  return graph;
}

void expect_equal(const Winners& expected, const Winners& found) {
  ASSERT_EQ(expected.first, found.first);
  ASSERT_EQ(expected.second, found.second);
  ASSERT_EQ(expected.first_m2, found.first_m2);
  ASSERT_EQ(expected.second_m2, found.second_m2);
}

// Runs the test body once per instruction set of this machine.
class WinnerSearchTest : public testing::TestWithParam<std::int64_t> {
 protected:
  void SetUp() override { hwy::SetSupportedTargetsForTest(GetParam()); }
  void TearDown() override { hwy::SetSupportedTargetsForTest(0); }
};

// Two nodes, three nodes, ... around the lanes of a vector: the answer is that of a plain loop.
TEST_P(WinnerSearchTest, EqualsBruteForceForFewNodes) {
  base::Rng rng(1);
  for (int num_nodes = 2; num_nodes < 70; ++num_nodes) {
    for (const Shape shape : kShapes) {
      const Graph graph = random_graph(shape, num_nodes, rng);
      for (int i = 0; i < 20; ++i) {
        const Eigen::Vector3f v = random_point(shape, rng);
        expect_equal(brute_force(graph, v), nearest_two_linear(graph, v));
      }
    }
  }
}

// The same for a thousand nodes, also for signals far away from all of them.
TEST_P(WinnerSearchTest, EqualsBruteForceForManyNodes) {
  base::Rng rng(2);
  for (const Shape shape : kShapes) {
    const Graph graph = random_graph(shape, 1000, rng);
    for (int i = 0; i < 500; ++i) {
      const Eigen::Vector3f v = (i % 5 == 0 ? 1000.0F : 1.0F) * random_point(kShapes[i % 6], rng);
      expect_equal(brute_force(graph, v), nearest_two_linear(graph, v));
    }
  }
}

// The cells give the answer of the plain loop while nodes come, go, move and change area; some
// searches are answered by cells alone.
TEST_P(WinnerSearchTest, CellsEqualBruteForce) {
  base::Rng rng(3);
  for (const Shape shape : kShapes) {
    Graph graph(300, 4);
    WinnerSearch search(graph.padded_slots());
    std::vector<std::uint8_t> inside(static_cast<std::size_t>(graph.padded_slots()));
    for (int i = 0; i < 6000; ++i) {
      const Eigen::Vector3f v = (i % 50 == 0 ? 1000.0F : 1.0F) * random_point(shape, rng);
      const auto slot = static_cast<int>(rng.below(300));
      if (graph.num_nodes() < 2 || (!graph.alive(slot) && graph.num_nodes() < 300)) {
        const int added = graph.add_node(v);
        inside[added] = v.x() > 1.0F ? 1 : 0;
        search.add(added, inside[added] != 0, v);
      } else if (i % 10 == 0 && graph.num_nodes() > 2) {
        search.remove(slot);
        inside[slot] = 0;
        graph.remove_node(slot);
      } else {
        graph.move_towards(slot, v, 0.3F);
        search.move(slot, graph.position_m(slot));
      }
      if (graph.num_nodes() < 2) continue;
      const Eigen::Vector3f query = random_point(shape, rng);
      const Winners winners = search.nearest_two(graph, query);
      expect_equal(brute_force(graph, query), winners);
      if (HasFatalFailure()) return;
      search.learn_spacing(graph, winners);
    }
    if (shape == Shape::kUniform) {
      EXPECT_LT(search.counts().linear, search.counts().searches / 2);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AllTargets, WinnerSearchTest,
                         testing::ValuesIn(hwy::SupportedAndGeneratedTargets()),
                         [](const auto& target) {
                           return std::string(hwy::TargetName(target.param));
                         });

}  // namespace
}  // namespace ddgng
