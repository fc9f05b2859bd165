// SPDX-License-Identifier: BSD-3-Clause
// Clouds that nobody wants: the estimate stays finite, bounded and calm.
#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/rng.h"
#include "ladder/ladder.h"
#include "tests/support/ladder_scene.h"

namespace {

using ladder::LadderEstimate;
using ladder::LadderParams;
using ladder::LadderState;
using ladder::LadderTracker;
using ladder::NodeCloud;
using test_support::LadderScene;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

bool is_finite(const LadderEstimate& e) {
  const auto finite = [](const auto& v) { return v.allFinite(); };
  bool all = std::isfinite(e.spacing_m) && std::isfinite(e.spacing_sigma_m);
  for (const auto& r : e.rungs) {
    all = all && finite(r.end0_m) && finite(r.end1_m) && finite(r.covariance_m2) &&
          std::isfinite(r.radius_m + r.sag_m + r.confidence + r.evaluation);
  }
  for (const auto& r : e.rails) all = all && finite(r.end0_m) && finite(r.end1_m);
  for (const auto& i : e.intervals) all = all && std::isfinite(i.from_m + i.to_m);
  for (const auto& g : e.grasps) all = all && finite(g.position_m) && finite(g.approach);
  return all;
}

void add_node(NodeCloud& cloud, float x_m, float y_m, float z_m) {
  cloud.id.push_back(cloud.num_nodes());
  cloud.x_m.push_back(x_m);
  cloud.y_m.push_back(y_m);
  cloud.z_m.push_back(z_m);
  cloud.node_class.push_back(ladder::NodeClass::kObstacle);
  cloud.plane.push_back(-1);
}

class OddInputs : public testing::TestWithParam<ladder::Mode> {
 protected:
  LadderParams params() const {
    LadderParams params;
    params.mode = GetParam();
    return params;
  }
};

INSTANTIATE_TEST_SUITE_P(BothModes, OddInputs,
                         testing::Values(ladder::Mode::kDefault, ladder::Mode::kPaper));

// Before the first frame nothing is known; an empty cloud tells that there is no ladder.
TEST_P(OddInputs, EmptyCloudHasNoLadder) {
  LadderTracker tracker(params());
  const LadderEstimate& estimate = tracker.update(NodeCloud{});
  EXPECT_EQ(estimate.state, LadderState::kNone);
  EXPECT_TRUE(estimate.rungs.empty());
  EXPECT_TRUE(estimate.grasps.empty());
}

// A single node is no bar.
TEST_P(OddInputs, OneNodeIsNothing) {
  LadderTracker tracker(params());
  NodeCloud cloud;
  add_node(cloud, 1.0F, 0.0F, 1.0F);
  EXPECT_TRUE(tracker.update(cloud).rungs.empty());
}

// Nodes all in one place have no direction and make no bar.
TEST_P(OddInputs, CoincidentNodesMakeNoBar) {
  LadderTracker tracker(params());
  NodeCloud cloud;
  for (int i = 0; i < 300; ++i) add_node(cloud, 1.0F, 0.0F, 1.0F);
  for (int i = 1; i < 300; ++i) cloud.edges.push_back({i - 1, i});
  cloud.suspected.push_back({{1.0F, 0.0F, 1.0F}, {1.0F, 1.0F, 1.0F}});
  const LadderEstimate& estimate = tracker.update(cloud);
  EXPECT_TRUE(estimate.rungs.empty());
  EXPECT_TRUE(estimate.rails.empty());
}

// Nodes exactly on a line, without moments, are a bar (in default mode once it has its evidence)
// and give finite numbers.
TEST_P(OddInputs, ExactLineWithoutMomentsIsFinite) {
  LadderTracker tracker(params());
  NodeCloud cloud;
  for (int i = 0; i < 60; ++i) add_node(cloud, 1.0F, 0.3F - 0.01F * static_cast<float>(i), 1.0F);
  for (int i = 1; i < 60; ++i) cloud.edges.push_back({i - 1, i});
  cloud.suspected.push_back({{1.0F, 0.0F, 1.0F}, {1.0F, 2.0F, 1.0F}});
  LadderEstimate estimate;
  for (cloud.sequence = 1; cloud.sequence <= 3; ++cloud.sequence) estimate = tracker.update(cloud);
  EXPECT_EQ(estimate.rungs.size(), 1U);
  EXPECT_TRUE(is_finite(estimate));
}

// NaN and infinite nodes and moments are passed over; the rest is found as before.
TEST_P(OddInputs, NanNodesAreLeftOut) {
  LadderScene scene(5);
  scene.add_ladder({});
  LadderTracker tracker(params());
  base::Rng rng(1);
  LadderEstimate estimate;
  for (int frame = 0; frame < 6; ++frame) {
    NodeCloud cloud = scene.cloud(frame);
    for (int k = 0; k < 20; ++k) {
      const int i = static_cast<int>(rng.below(cloud.num_nodes()));
      cloud.x_m[i] = kNan;
      cloud.z_m[cloud.num_nodes() - 1 - i] = std::numeric_limits<float>::infinity();
      auto& moment = cloud.moments[rng.below(static_cast<std::uint32_t>(cloud.moments.size()))];
      moment.mean_m.y() = kNan;
      cloud.moments[k].weight = std::numeric_limits<float>::infinity();
      cloud.moments[k + 30].xx_m2 = kNan;
      cloud.moments[k + 60].weight = -1.0F;
      cloud.moments[k + 90].mean_m.x() = 3e38F;
    }
    estimate = tracker.update(cloud);
    EXPECT_TRUE(is_finite(estimate));
  }
  if (GetParam() == ladder::Mode::kDefault) {
    EXPECT_EQ(estimate.state, LadderState::kConfirmed);
  }
}

// A cloud that contradicts itself counts as an empty one.
TEST_P(OddInputs, InconsistentCloudsCountAsEmpty) {
  LadderScene scene(5);
  scene.add_bar({1.0, 0.4, 1.0}, {1.0, -0.4, 1.0}, 0.03);
  const NodeCloud good = scene.cloud(0);
  ASSERT_TRUE(ladder::is_consistent(good));
  const auto refused = [&](auto&& spoil) {
    NodeCloud bad = good;
    spoil(bad);
    LadderTracker tracker(params());
    return !ladder::is_consistent(bad) && tracker.update(bad).rungs.empty();
  };
  EXPECT_TRUE(refused([](NodeCloud& c) { c.x_m.pop_back(); }));
  EXPECT_TRUE(refused([](NodeCloud& c) { c.plane.push_back(0); }));
  EXPECT_TRUE(refused([](NodeCloud& c) { c.node_class.clear(); }));
  EXPECT_TRUE(refused([](NodeCloud& c) { c.id[1] = c.id[0]; }));
  EXPECT_TRUE(refused([](NodeCloud& c) { c.moments[0].node = -1; }));
  EXPECT_TRUE(refused([](NodeCloud& c) { c.moments.back().node = c.num_nodes(); }));
  EXPECT_TRUE(refused([](NodeCloud& c) { c.moments[0].head = 4; }));
  EXPECT_TRUE(refused([](NodeCloud& c) { std::swap(c.moments[0], c.moments[1]); }));
  EXPECT_TRUE(refused([](NodeCloud& c) { c.edges[0].b = c.num_nodes(); }));
  EXPECT_TRUE(refused([](NodeCloud& c) { c.edges[0].a = c.edges[0].b; }));
  EXPECT_TRUE(refused([](NodeCloud& c) { c.body_position_m.x() = kNan; }));
  EXPECT_TRUE(refused([](NodeCloud& c) { c.head_position_m[2].z() = kNan; }));
  EXPECT_TRUE(refused([](NodeCloud& c) { c.pixel_pitch_rad = kNan; }));
}

// The same frame handed in twice changes nothing: evidence counts measurements, not calls.
TEST_P(OddInputs, RepeatedFrameChangesNothing) {
  LadderScene scene(5);
  scene.add_ladder({});
  LadderTracker tracker(params());
  const NodeCloud cloud = scene.cloud(0);
  const LadderEstimate once = tracker.update(cloud);
  for (int i = 0; i < 20; ++i) tracker.update(cloud);
  const LadderEstimate& many = tracker.update(cloud);
  EXPECT_EQ(many.state, LadderState::kNone);
  ASSERT_EQ(many.rungs.size(), once.rungs.size());
  for (std::size_t i = 0; i < once.rungs.size(); ++i) {
    EXPECT_EQ(many.rungs[i].age, once.rungs[i].age);
  }
}

// Ten thousand nodes anywhere: no more bars and rungs come out than there is room for.
TEST_P(OddInputs, TenThousandNodesAreBounded) {
  const LadderParams p = params();
  LadderTracker tracker(p);
  base::Rng rng(3);
  for (std::uint64_t frame = 0; frame < 3; ++frame) {
    NodeCloud cloud;
    cloud.sequence = frame;
    for (int i = 0; i < 10000; ++i) {
      add_node(cloud, static_cast<float>(rng.uniform()), static_cast<float>(rng.uniform()),
               static_cast<float>(2.0 * rng.uniform()));
    }
    for (int i = 0; i < 40000; ++i) {
      const int a = static_cast<int>(rng.below(10000));
      const int b = static_cast<int>(rng.below(10000));
      if (a != b) cloud.edges.push_back({a, b});
    }
    cloud.suspected.push_back({{0.5F, 0.5F, 1.0F}, {1.0F, 1.0F, 2.0F}});
    const LadderEstimate& estimate = tracker.update(cloud);
    EXPECT_TRUE(is_finite(estimate));
    EXPECT_LE(estimate.rungs.size(), static_cast<std::size_t>(p.max_tracks));
    EXPECT_EQ(estimate.state, LadderState::kNone);
  }
}

// Without a live head, with memories of their points only, the body's place stands in.
TEST_P(OddInputs, DeadHeadsAreFinite) {
  LadderScene scene(5);
  scene.add_ladder({});
  LadderTracker tracker(params());
  LadderEstimate estimate;
  for (int frame = 0; frame < 5; ++frame) {
    NodeCloud cloud = scene.cloud(frame);
    cloud.head_valid.fill(false);
    for (auto& head : cloud.head_position_m) head.setConstant(kNan);
    estimate = tracker.update(cloud);
  }
  EXPECT_TRUE(is_finite(estimate));
  if (GetParam() == ladder::Mode::kDefault) {
    EXPECT_EQ(estimate.state, LadderState::kConfirmed);
  }
}

// One dead head of four costs no rung.
TEST(OddInputsDefault, OneDeadHeadCostsNoRung) {
  LadderScene scene(5);
  scene.add_ladder({});
  LadderTracker tracker{LadderParams{}};
  LadderEstimate estimate;
  for (int frame = 0; frame < 6; ++frame) {
    NodeCloud cloud = scene.cloud(frame);
    std::erase_if(cloud.moments, [](const auto& m) { return m.head == 2; });
    cloud.head_valid[2] = false;
    estimate = tracker.update(cloud);
  }
  EXPECT_EQ(std::count_if(estimate.rungs.begin(), estimate.rungs.end(),
                          [](const auto& r) { return r.state == ladder::RungState::kTrusted; }),
            8);
}

// What vanishes is distrusted within 0.3 s (at 15 Hz) and forgotten after twelve frames.
TEST(OddInputsDefault, VanishedLadderIsDistrustedSoon) {
  LadderScene scene(5);
  scene.add_ladder({});
  LadderTracker tracker{LadderParams{}};
  for (int frame = 0; frame < 30; ++frame) tracker.update(scene.cloud(frame));
  NodeCloud nothing;
  for (int frame = 30; frame < 34; ++frame) {
    nothing.sequence = frame;
    tracker.update(nothing);
  }
  nothing.sequence = 34;
  const LadderEstimate distrusted = tracker.update(nothing);
  for (const auto& rung : distrusted.rungs) {
    EXPECT_NE(rung.state, ladder::RungState::kTrusted);
  }
  EXPECT_TRUE(distrusted.grasps.empty());
  for (int frame = 35; frame < 43; ++frame) {
    nothing.sequence = frame;
    tracker.update(nothing);
  }
  nothing.sequence = 43;
  const LadderEstimate& forgotten = tracker.update(nothing);
  EXPECT_TRUE(forgotten.rungs.empty());
  EXPECT_EQ(forgotten.state, LadderState::kNone);
}

}  // namespace
