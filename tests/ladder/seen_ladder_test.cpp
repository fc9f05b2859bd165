// SPDX-License-Identifier: BSD-3-Clause
// What a ladder's regularity says about where the heads sit.
#include "ladder/seen_ladder.h"

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "ladder/head_alignment.h"

namespace ladder {
namespace {

using Eigen::Vector3d;

constexpr int kNumRungs = 4;
constexpr int kNumNodes = 7;  // of a rung
constexpr double kSpacing_m = 0.3;
constexpr double kRadius_m = 0.014;
constexpr double kFront_m = 0.011;
constexpr double kDistance_m = 1.0;

Vector3d head_m(int head) {
  return {0.0, head % 2 == 0 ? 0.03 : -0.03, head < 2 ? 0.02 : -0.02};
}

double height_m(int rung) {
  return -0.4 + kSpacing_m * rung;
}

/// Upper rungs are seen by heads 0 and 1, lower ones by 2 and 3. Each head errs by its shift.
struct Scene {
  explicit Scene(const std::array<Vector3d, kNumHeads>& shift_m) : nodes(LadderParams{}) {
    for (int head = 0; head < kNumHeads; ++head) {
      cloud.head_valid[head] = true;
      cloud.head_position_m[head] = head_m(head).cast<float>();
    }
    for (int rung = 0; rung < kNumRungs; ++rung) {
      for (int i = 0; i < kNumNodes; ++i) add_node(rung, -0.15 + 0.05 * i, shift_m);
    }
    nodes.gather(cloud);
    bars.rails.resize(2);
    bars.rails[0].axis = {Vector3d(kDistance_m, 0.2, 0.0), Vector3d::UnitZ()};
    ladder.left = 0;
    ladder.right = 1;
    ladder.along = -Vector3d::UnitY();
    for (int rung = 0; rung < kNumRungs; ++rung) add_bar(rung);
  }

  void add_node(int rung, double y_m, const std::array<Vector3d, kNumHeads>& shift_m) {
    const int node = cloud.num_nodes();
    const Vector3d place_m(kDistance_m, y_m, height_m(rung));
    cloud.id.push_back(node);
    cloud.x_m.push_back(static_cast<float>(place_m.x()));
    cloud.y_m.push_back(static_cast<float>(place_m.y()));
    cloud.z_m.push_back(static_cast<float>(place_m.z()));
    cloud.node_class.push_back(NodeClass::kUnknown);
    cloud.plane.push_back(-1);
    for (const int head : {rung < 2 ? 2 : 0, rung < 2 ? 3 : 1}) {
      Vector3d view = place_m - head_m(head);
      view.y() = 0.0;
      HeadMoment m;
      m.node = node;
      m.head = head;
      m.weight = 20.0F;
      m.mean_m = (place_m - kFront_m * view.normalized() - shift_m[head]).cast<float>();
      m.zz_m2 = static_cast<float>(kRadius_m * kRadius_m / 3.0);
      cloud.moments.push_back(m);
    }
  }

  void add_bar(int rung) {
    Bar bar;
    bar.axis = {Vector3d(kDistance_m, 0.0, height_m(rung)), -Vector3d::UnitY()};
    bar.first_member = static_cast<int>(bars.members.size());
    for (int k = 0; k < nodes.size(); ++k) {
      if (std::abs(nodes.position_m(k).z() - height_m(rung)) < 0.1) bars.members.push_back(k);
    }
    bar.num_members = static_cast<int>(bars.members.size()) - bar.first_member;
    ladder.rungs.push_back({rung, rung, -1.0, 1.0, kFront_m, 0.85 * kRadius_m});
    bars.rungs.push_back(bar);
  }

  HeadCorrections solve() const {
    AlignmentEquations equations;
    add_ladder({cloud, nodes, bars}, ladder, LadderParams{}.align, 1.0, equations);
    HeadCorrections corrections;
    RangeError range_error;
    EXPECT_TRUE(equations.solve({0.0175, 0.010, 0.003}, corrections, range_error));
    return corrections;
  }

  NodeCloud cloud;
  BarNodes nodes;
  BarSet bars;
  SeenLadder ladder;
};

/// How far the correction moves what the head sees of that rung, upwards.
double lift_m(const HeadCorrections& corrections, int head, int rung) {
  const Vector3d arm_m = Vector3d(kDistance_m, 0.0, height_m(rung)) - head_m(head);
  const HeadCorrection& correction = corrections[head];
  return (correction.shift_m + correction.turn_rad.cross(arm_m)).z();
}

std::vector<int> levels_of(const std::vector<double>& heights_m) {
  std::vector<int> levels(heights_m.size(), 7);
  number_levels(heights_m, LadderTestParams{}, levels);
  return levels;
}

// Nothing, one rung, two at one place: the first is the lowest, what is no step above it is none.
TEST(SeenLadder, NumbersOddLists) {
  EXPECT_TRUE(levels_of({}).empty());
  EXPECT_EQ(levels_of({0.4}), (std::vector<int>{0}));
  EXPECT_EQ(levels_of({0.4, 0.4}), (std::vector<int>{0, -1}));
  EXPECT_EQ(levels_of({std::numeric_limits<double>::quiet_NaN(), 0.4}), (std::vector<int>{0, -1}));
}

// A missing rung leaves its number free; one between two levels gets none.
TEST(SeenLadder, NumbersByWholeSteps) {
  EXPECT_EQ(levels_of({0.1, 0.4, 1.01, 1.3}), (std::vector<int>{0, 1, 3, 4}));
  EXPECT_EQ(levels_of({0.1, 0.4, 0.85, 1.0}), (std::vector<int>{0, 1, -1, 3}));
}

// A ladder that is regular already moves no head.
TEST(SeenLadder, GoodHeadsStay) {
  const Vector3d none = Vector3d::Zero();
  for (const HeadCorrection& correction : Scene({none, none, none, none}).solve()) {
    EXPECT_LT(correction.shift_m.norm(), 1e-6);
    EXPECT_LT(correction.turn_rad.norm(), 1e-6);
  }
}

// Upper heads that see their rungs 8 mm too low are told from the spacing: no plane shows that.
TEST(SeenLadder, SpacingShowsTheHeightOfHeads) {
  const Vector3d low(0.0, 0.0, 0.008), none = Vector3d::Zero();
  const HeadCorrections corrections = Scene({low, low, none, none}).solve();
  // One spacing and one height are free: what is left is how far the pairs of rungs are apart.
  const double upper_m = 0.5 * (lift_m(corrections, 0, 2) + lift_m(corrections, 1, 2));
  const double lower_m = 0.5 * (lift_m(corrections, 2, 1) + lift_m(corrections, 3, 1));
  const double top_m = 0.5 * (lift_m(corrections, 0, 3) + lift_m(corrections, 1, 3));
  const double bottom_m = 0.5 * (lift_m(corrections, 2, 0) + lift_m(corrections, 3, 0));
  const double irregular_m = 3.0 * (upper_m - lower_m) - (top_m - bottom_m);
  EXPECT_NEAR(irregular_m, 2.0 * low.z(), 0.002);
}

// A head whose image ends within a rung sees its middle elsewhere: it says nothing there.
TEST(SeenLadder, CutOffRungsTeachNothing) {
  const Vector3d none = Vector3d::Zero();
  Scene scene({none, none, none, none});
  for (HeadMoment& m : scene.cloud.moments) {
    if (m.head != 2) continue;
    m.mean_m.z() -= static_cast<float>(0.5 * kRadius_m);
    m.zz_m2 *= 0.25F;
  }
  const HeadCorrections corrections = scene.solve();
  EXPECT_LT(corrections[2].shift_m.norm(), 1e-9);
  EXPECT_LT(corrections[3].shift_m.norm(), 1e-6);
}

// However long it is looked at, a ladder counts once: its irregularities are not averaged away.
TEST(SeenLadder, CountsOnce) {
  const Vector3d low(0.0, 0.0, 0.008), none = Vector3d::Zero();
  const Scene scene({low, low, none, none});
  const auto after = [&](int num_frames) {
    HeadAlignment alignment{LadderParams{}};
    for (int i = 0; i < num_frames; ++i) {
      alignment.learn(scene.cloud, scene.nodes, scene.bars, scene.ladder);
    }
    return alignment.corrections()[0].shift_m.z();
  };
  EXPECT_GT(after(50), 1e-5);
  EXPECT_NEAR(after(50), after(400), 0.01 * after(400));
}

// Without a ladder, with a head of unknown place, or from what is no number, nothing is learnt.
TEST(SeenLadder, OddFramesTeachNothing) {
  const Vector3d low(0.0, 0.0, 0.008), none = Vector3d::Zero();
  const auto turned = [](const HeadCorrections& corrections) {
    double sum = 0.0;
    for (const HeadCorrection& one : corrections) sum += one.shift_m.norm() + one.turn_rad.norm();
    return sum;
  };
  Scene no_ladder({low, low, none, none});
  no_ladder.ladder.left = -1;
  EXPECT_EQ(turned(no_ladder.solve()), 0.0);
  Scene blind({low, low, none, none});
  blind.cloud.head_valid = {};
  EXPECT_EQ(turned(blind.solve()), 0.0);
  Scene no_number({low, low, none, none});
  for (HeadMoment& m : no_number.cloud.moments) {
    m.mean_m.z() = std::numeric_limits<float>::quiet_NaN();
  }
  EXPECT_EQ(turned(no_number.solve()), 0.0);
}

}  // namespace
}  // namespace ladder
