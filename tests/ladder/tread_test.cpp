// SPDX-License-Identifier: BSD-3-Clause
// Boards are told from bars by what is seen behind them: alone, rung by rung, and on whole ladders.
#include "ladder/tread_test.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "ladder/ladder.h"
#include "tests/support/ladder_scene.h"

namespace {

using ladder::BarFront;
using ladder::BarNodes;
using ladder::LadderEstimate;
using ladder::LadderParams;
using ladder::LadderTracker;
using ladder::MeasuredBar;
using ladder::NodeCloud;
using ladder::Reason;
using ladder::RungState;
using ladder::TreadTest;
using test_support::LadderScene;
using test_support::LadderShape;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A rung of a ladder 1 m away and so much higher than the head, with such a share of its points
/// behind it.
MeasuredBar rung(double height_m, double surplus) {
  MeasuredBar bar;
  bar.on_ladder = true;
  bar.depth = Eigen::Vector3d(1.0, 0.0, height_m).normalized();
  bar.weight = 100.0;
  bar.radius_m = 0.014;
  bar.surplus = surplus;
  return bar;
}

/// What three rungs of boards look like, and three round ones.
const std::vector<MeasuredBar> kTreads = {rung(-0.3, 0.3), rung(0.0, 0.0), rung(0.3, 0.3)};
const std::vector<MeasuredBar> kRound = {rung(-0.3, 0.02), rung(0.0, 0.0), rung(0.3, -0.01)};

bool has_treads(const std::vector<MeasuredBar>& bars, int num_frames = 1) {
  TreadTest test{LadderParams{}};
  for (int frame = 0; frame < num_frames; ++frame) test.learn(bars);
  return test.has_treads();
}

// Nothing, what is no number or has no points, a free bar and one at the heads' height tell
// nothing.
TEST(TreadTest, OddBarsTellNothing) {
  EXPECT_FALSE(TreadTest{LadderParams{}}.has_treads());
  EXPECT_FALSE(has_treads({}));
  std::vector<MeasuredBar> odd(6, rung(0.3, 10.0));
  odd[0].surplus = kNan;
  odd[1].radius_m = std::numeric_limits<double>::infinity();
  odd[2].depth.z() = kNan;
  odd[3].weight = 0.0;
  odd[4].on_ladder = false;
  odd[5].depth = Eigen::Vector3d::UnitX();
  EXPECT_FALSE(has_treads(odd, 5));
  std::vector<MeasuredBar> above = {rung(0.3, 10.0)};
  above[0].depth = Eigen::Vector3d::UnitZ();
  EXPECT_FALSE(has_treads(above));
}

// Boards are told from round rungs at once, whatever one of several rungs looks like; one found at
// the wide height has no say unless it shows a board.
TEST(TreadTest, MostRungsDecide) {
  EXPECT_TRUE(has_treads(kTreads));
  EXPECT_FALSE(has_treads(kRound));
  std::vector<MeasuredBar> bars = {rung(-0.6, 0.6), rung(-0.3, 0.3), rung(0.3, 0.3),
                                   rung(0.6, -0.3)};
  EXPECT_TRUE(has_treads(bars));
  bars.push_back(rung(-0.9, -0.9));
  bars.push_back(rung(0.9, -0.9));
  EXPECT_FALSE(has_treads(bars));
  bars[4].is_wide = bars[5].is_wide = true;
  EXPECT_TRUE(has_treads(bars));
  for (MeasuredBar& bar : bars) bar.is_wide = true;
  EXPECT_TRUE(has_treads(bars));
  bars = {rung(-0.6, 0.0), rung(-0.3, 0.0), rung(0.3, 0.4), rung(0.6, 0.0)};
  EXPECT_FALSE(has_treads(bars));
}

// What was seen aslant lasts while all is at the heads' height; other rungs change it within ten
// frames, a reset at once.
TEST(TreadTest, LastsUntilSeenOtherwise) {
  TreadTest test{LadderParams{}};
  test.learn(kTreads);
  for (int frame = 0; frame < 1000; ++frame) test.learn({rung(0.0, 0.0), rung(0.05, 0.0)});
  EXPECT_TRUE(test.has_treads());
  for (int frame = 0; frame < 10; ++frame) test.learn(kRound);
  EXPECT_FALSE(test.has_treads());
  for (int frame = 0; frame < 10; ++frame) test.learn(kTreads);
  EXPECT_TRUE(test.has_treads());
  test.reset();
  EXPECT_FALSE(test.has_treads());
}

/// A node of ten points, `reach_m` to either side along x.
void add_node(double x_m, double y_m, double z_m, double reach_m, NodeCloud& cloud) {
  ladder::HeadMoment moment;
  moment.node = cloud.num_nodes();
  moment.weight = 10.0F;
  moment.mean_m = Eigen::Vector3d(x_m, y_m, z_m).cast<float>();
  moment.xx_m2 = static_cast<float>(reach_m * reach_m / 3.0);
  cloud.moments.push_back(moment);
  cloud.id.push_back(moment.node);
  cloud.x_m.push_back(moment.mean_m.x());
  cloud.y_m.push_back(moment.mean_m.y());
  cloud.z_m.push_back(moment.mean_m.z());
  cloud.node_class.push_back(ladder::NodeClass::kUnknown);
  cloud.plane.push_back(-1);
}

/// Of a front 1 m ahead, 0.4 m wide.
double surplus(const NodeCloud& cloud) {
  const LadderParams params;
  BarNodes nodes(params);
  nodes.gather(cloud);
  const BarFront front{
      {{1.0, 0.0, 0.5}, -Eigen::Vector3d::UnitY()}, -0.2, 0.2, Eigen::Vector3d::UnitX()};
  return ladder::surplus_behind(nodes, front, params.test);
}

// Nothing, what lies on the front, above it, beyond its ends or far behind it is no surplus.
TEST(SurplusBehind, NothingElseCounts) {
  NodeCloud cloud;
  EXPECT_EQ(surplus(cloud), 0.0);
  add_node(1.0, 0.0, 0.5, 0.01, cloud);
  add_node(1.075, 0.0, 0.55, 0.01, cloud);
  add_node(1.075, 0.25, 0.5, 0.01, cloud);
  add_node(1.2, 0.0, 0.5, 0.01, cloud);
  add_node(std::numeric_limits<double>::quiet_NaN(), 0.0, 0.5, 0.01, cloud);
  EXPECT_EQ(surplus(cloud), 0.0);
}

// Points closely behind count, of a node that reaches beyond the band its share; as many before
// take them away, as noise does.
TEST(SurplusBehind, CountsWhatIsBehindLessWhatIsBefore) {
  NodeCloud cloud;
  add_node(1.075, 0.0, 0.5, 0.01, cloud);
  EXPECT_NEAR(surplus(cloud), 10.0, 1e-6);
  add_node(1.105, 0.1, 0.5, 0.02, cloud);
  EXPECT_NEAR(surplus(cloud), 15.0, 0.01);
  add_node(0.925, 0.0, 0.5, 0.01, cloud);
  add_node(0.895, 0.1, 0.5, 0.02, cloud);
  EXPECT_NEAR(surplus(cloud), 0.0, 0.01);
}

struct Counts {
  int offered = 0;   ///< stretches, of all frames
  int too_deep = 0;  ///< refused as boards
  int trusted = 0;   ///< rungs of the last frame
};

Counts count(const LadderScene& scene) {
  constexpr int kNumFrames = 20;
  LadderTracker tracker{LadderParams{}};
  Counts counts;
  for (int frame = 0; frame < kNumFrames; ++frame) {
    const LadderEstimate& estimate = tracker.update(scene.cloud(frame));
    for (const ladder::Interval& interval : estimate.intervals) {
      counts.offered += interval.reason == Reason::kNone ? 1 : 0;
      counts.too_deep += interval.reason == Reason::kTooDeep ? 1 : 0;
    }
    counts.offered += static_cast<int>(estimate.grasps.size());
    counts.trusted = static_cast<int>(
        std::count_if(estimate.rungs.begin(), estimate.rungs.end(),
                      [](const auto& rung) { return rung.state == RungState::kTrusted; }));
  }
  return counts;
}

// Treads are trusted as bars and none is ever offered, not even at the heads' height; bars in their
// place are, in much noise as well, and none is held to be a tread.
TEST(Treads, AreSeenAndNeverOffered) {
  for (const double distance_m : {0.7, 1.1}) {
    for (const double yaw_rad : {0.0, -0.4}) {
      LadderShape shape;
      shape.distance_m = distance_m;
      shape.yaw_rad = yaw_rad;
      SCOPED_TRACE(testing::Message() << distance_m << " m, yaw " << yaw_rad);
      for (const double noise_m : {0.007, 0.02}) {
        LadderScene bars(5);
        bars.noise_sigma_m = noise_m;
        bars.add_ladder(shape);
        const Counts of_bars = count(bars);
        EXPECT_GT(of_bars.offered, 0);
        EXPECT_EQ(of_bars.too_deep, 0);
      }
      shape.tread_depth_m = 0.10;
      LadderScene treads(5);
      treads.add_ladder(shape);
      const Counts of_treads = count(treads);
      EXPECT_GE(of_treads.trusted, 3);
      EXPECT_EQ(of_treads.offered, 0);
      EXPECT_GT(of_treads.too_deep, 0);
    }
  }
}

}  // namespace
