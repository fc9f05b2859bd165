// SPDX-License-Identifier: BSD-3-Clause
// The paper mode against its literal, slow form on random graphs of nodes.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "base/rng.h"
#include "ladder/rung_correction.h"
#include "ladder/rung_evaluation.h"
#include "ladder/rung_tracker.h"
#include "tests/reference/rung_reference.h"

namespace {

using ladder::LadderParams;
using ladder::NodeCloud;
using ladder::PaperRung;

constexpr double kTolerance_m = 1e-9;

void add_node(NodeCloud& cloud, const Eigen::Vector3d& p) {
  cloud.id.push_back(3 * cloud.num_nodes() + 1);
  cloud.x_m.push_back(static_cast<float>(p.x()));
  cloud.y_m.push_back(static_cast<float>(p.y()));
  cloud.z_m.push_back(static_cast<float>(p.z()));
  cloud.node_class.push_back(ladder::NodeClass::kObstacle);
  cloud.plane.push_back(-1);
}

/// Noisy lines, level and upright, and nodes anywhere; edges between near nodes, some left out.
NodeCloud random_cloud(std::uint64_t seed, std::uint64_t sequence) {
  base::Rng shape(seed);
  base::Rng noise(seed, sequence + 1);
  NodeCloud cloud;
  cloud.sequence = sequence;
  for (int line = 0; line < 4; ++line) {
    const Eigen::Vector3d from(0.6, shape.uniform() - 0.5, 0.2 + shape.uniform());
    const Eigen::Vector3d to =
        from + (line % 2 == 0 ? Eigen::Vector3d(0.0, 0.3, 0.01) : Eigen::Vector3d(0.01, 0.0, 0.4));
    for (int i = 0; i < 25; ++i) {
      const Eigen::Vector3d off =
          0.004 * Eigen::Vector3d(noise.gaussian(), noise.gaussian(), noise.gaussian());
      add_node(cloud, from + i / 24.0 * (to - from) + off);
    }
  }
  for (int i = 0; i < 30; ++i) {
    add_node(cloud, {0.5 + 0.2 * noise.uniform(), noise.uniform() - 0.5, 1.2 * noise.uniform()});
  }
  for (int a = 0; a < cloud.num_nodes(); ++a) {
    for (int b = a + 1; b < cloud.num_nodes(); ++b) {
      const bool is_near = (cloud.node_m(a) - cloud.node_m(b)).norm() < 0.04;
      if (is_near && noise.uniform() < 0.9) cloud.edges.push_back({a, b});
    }
  }
  cloud.suspected.push_back({{0.6F, 0.0F, 0.6F}, {0.5F, 2.0F, 2.0F}});
  return cloud;
}

/// Ages short enough that rungs come and go within a few frames.
LadderParams quick_params() {
  LadderParams params = ladder::paper_params();
  params.paper.tries = 400;
  params.paper.age_initial = 3;
  params.paper.inlier_ratio = 1.5;
  return params;
}

void expect_same(const PaperRung& rung, const rung_reference::Rung& expected) {
  EXPECT_EQ(rung.num_inliers, expected.ci);
  EXPECT_EQ(rung.num_outliers, expected.co);
  EXPECT_NEAR(rung.evaluation, expected.r, 1e-9);
  const auto ends_near = [&](const Eigen::Vector3d& e1, const Eigen::Vector3d& e2) {
    return (rung.end1_m - e1).norm() < kTolerance_m && (rung.end2_m - e2).norm() < kTolerance_m;
  };
  // Which end is called the first is of no consequence: v(1) and v(2) run against the line.
  EXPECT_TRUE(ends_near(expected.e1, expected.e2) || ends_near(expected.e2, expected.e1));
}

PaperRung roomy_rung() {
  PaperRung rung;
  rung.member_id.reserve(1024);
  rung.outlier_id.reserve(1024);
  return rung;
}

// Every pair of nodes is accepted or refused as by Algorithm 4, with the same counts and ends.
TEST(PaperReference, EvaluatesEveryPairAsAlgorithm4) {
  const LadderParams params = quick_params();
  int num_accepted = 0;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const NodeCloud cloud = random_cloud(seed, 0);
    const rung_reference::Graph graph = rung_reference::to_graph(cloud);
    ladder::Adjacency adjacency(params.max_cloud_nodes, params.max_cloud_edges);
    adjacency.build(cloud);
    ladder::RungEvaluation evaluation(params);
    base::Rng rng(seed);
    for (int i = 0; i < 4000; ++i) {
      const int n1 = static_cast<int>(rng.below(cloud.num_nodes()));
      const int n2 = static_cast<int>(rng.below(cloud.num_nodes()));
      if (n1 == n2) continue;
      PaperRung rung = roomy_rung();
      const bool accepted = evaluation.evaluate(cloud, adjacency, n1, n2, rung);
      const auto expected = rung_reference::algorithm_4(graph, n1, n2, params.paper);
      ASSERT_EQ(accepted, expected.has_value()) << seed << ": " << n1 << ", " << n2;
      if (!accepted) continue;
      ++num_accepted;
      expect_same(rung, *expected);
      EXPECT_EQ(std::set<int>(rung.member_id.begin(), rung.member_id.end()), expected->members);
    }
  }
  EXPECT_GT(num_accepted, 100);
}

// A rung is moved by Eq. (8)-(11) over many frames as in the literal form.
TEST(PaperReference, CorrectsPositionsAsEquations8To11) {
  const LadderParams params = quick_params();
  ladder::Adjacency adjacency(params.max_cloud_nodes, params.max_cloud_edges);
  ladder::RungEvaluation evaluation(params);
  ladder::RungCorrection correction(params);
  int num_corrections = 0;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    PaperRung rung = roomy_rung();
    std::optional<rung_reference::Rung> expected;
    for (std::uint64_t sequence = 0; sequence < 10; ++sequence) {
      const NodeCloud cloud = random_cloud(seed, sequence);
      const rung_reference::Graph graph = rung_reference::to_graph(cloud);
      adjacency.build(cloud);
      if (!expected) {
        if (evaluation.evaluate(cloud, adjacency, 2, 20, rung)) {
          expected = rung_reference::algorithm_4(graph, 2, 20, params.paper);
        }
        continue;
      }
      const bool alive = correction.correct(cloud, adjacency, rung);
      ASSERT_EQ(alive, rung_reference::correct_position(graph, params.paper, *expected));
      if (!alive) break;
      ++num_corrections;
      expect_same(rung, *expected);
    }
  }
  EXPECT_GT(num_corrections, 20);
}

// Whole runs of Algorithm 3 keep the same rungs with the same ages.
TEST(PaperReference, RunsAlgorithm3) {
  const LadderParams params = quick_params();
  int num_rungs = 0;
  int oldest = 0;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    ladder::RungTracker tracker(params);
    std::vector<rung_reference::Rung> expected;
    for (std::uint64_t sequence = 0; sequence < 15; ++sequence) {
      const NodeCloud cloud = random_cloud(seed, sequence);
      tracker.update(cloud);
      rung_reference::algorithm_3(cloud, params.paper, params.seed, expected);
      const auto rungs = tracker.rungs();
      ASSERT_EQ(rungs.size(), expected.size()) << seed << ", " << sequence;
      for (std::size_t i = 0; i < rungs.size(); ++i) {
        expect_same(rungs[i], expected[i]);
        EXPECT_EQ(rungs[i].age, expected[i].age);
        oldest = std::max(oldest, rungs[i].age);
      }
      num_rungs += static_cast<int>(rungs.size());
    }
  }
  EXPECT_GT(num_rungs, 100);
  EXPECT_GT(oldest, params.paper.age_initial + 5);
}

// Without a suspected object nothing new is drawn, and without nodes nothing old remains.
TEST(PaperReference, DrawsOnlyInSuspectedBoxesAndForgetsWhatIsGone) {
  const LadderParams params = quick_params();
  ladder::RungTracker tracker(params);
  NodeCloud cloud = random_cloud(1, 0);
  cloud.suspected.clear();
  tracker.update(cloud);
  EXPECT_TRUE(tracker.rungs().empty());
  for (std::uint64_t i = 1; i < 5; ++i) tracker.update(random_cloud(1, i));
  EXPECT_FALSE(tracker.rungs().empty());
  tracker.update(NodeCloud{});
  EXPECT_TRUE(tracker.rungs().empty());
}

}  // namespace
