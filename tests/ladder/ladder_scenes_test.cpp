// SPDX-License-Identifier: BSD-3-Clause
// The default mode on drawn scenes with exact truth: what is found, what is flagged, what is
// offered.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "ladder/ladder.h"
#include "tests/support/ladder_scene.h"

namespace {

using ladder::LadderEstimate;
using ladder::LadderParams;
using ladder::LadderState;
using ladder::LadderTracker;
using ladder::Rung;
using ladder::RungState;
using test_support::LadderScene;
using test_support::LadderShape;
using test_support::RungTruth;

constexpr int kNumFrames = 8;

LadderEstimate run(const LadderScene& scene, int num_frames = kNumFrames) {
  LadderTracker tracker{LadderParams{}};
  LadderEstimate estimate;
  for (int frame = 0; frame < num_frames; ++frame) estimate = tracker.update(scene.cloud(frame));
  return estimate;
}

const Rung* match(const LadderEstimate& estimate, const RungTruth& truth) {
  const Eigen::Vector3d middle = 0.5 * (truth.end0_m + truth.end1_m);
  for (const Rung& rung : estimate.rungs) {
    const double off = (0.5 * (rung.end0_m + rung.end1_m) - middle).norm();
    if (off < 0.05) return &rung;
  }
  return nullptr;
}

int num_trusted(const LadderEstimate& estimate) {
  return static_cast<int>(
      std::count_if(estimate.rungs.begin(), estimate.rungs.end(),
                    [](const Rung& rung) { return rung.state == RungState::kTrusted; }));
}

// Every rung of a plain ladder is trusted, on its axis, between the rails' inner faces.
TEST(LadderScenes, FindsEveryRungOfAPlainLadder) {
  for (const double distance_m : {0.6, 1.0, 1.5}) {
    for (const double yaw_rad : {0.0, 0.26, -0.52}) {
      LadderShape shape;
      shape.distance_m = distance_m;
      shape.yaw_rad = yaw_rad;
      LadderScene scene(7);
      scene.add_ladder(shape);
      scene.add_front(distance_m + 0.9, 1.0, 0.0, 2.5, true);
      const LadderEstimate estimate = run(scene);
      SCOPED_TRACE(testing::Message() << distance_m << " m, yaw " << yaw_rad);
      ASSERT_EQ(estimate.state, LadderState::kConfirmed);
      EXPECT_NEAR(estimate.spacing_m, 0.30, 0.003);
      EXPECT_EQ(num_trusted(estimate), shape.num_rungs);
      for (const RungTruth& truth : scene.truth) {
        const Rung* rung = match(estimate, truth);
        ASSERT_NE(rung, nullptr);
        EXPECT_EQ(rung->flags, 0);
        EXPECT_LT((rung->end0_m - truth.end0_m).norm(), 0.012);
        EXPECT_LT((rung->end1_m - truth.end1_m).norm(), 0.012);
      }
    }
  }
}

// A ladder is confirmed within four frames.
TEST(LadderScenes, ConfirmsWithinFourFrames) {
  LadderScene scene(3);
  scene.add_ladder({});
  EXPECT_EQ(run(scene, 2).state, LadderState::kNone);
  const LadderEstimate estimate = run(scene, 4);
  EXPECT_EQ(estimate.state, LadderState::kConfirmed);
  EXPECT_EQ(num_trusted(estimate), 8);
}

// A missing rung leaves a gap: the others stand, none is reported where none is.
TEST(LadderScenes, MissingRungLeavesAGap) {
  LadderShape shape;
  shape.missing_rung = 3;
  LadderScene scene(4);
  scene.add_ladder(shape);
  const LadderEstimate estimate = run(scene);
  EXPECT_EQ(estimate.state, LadderState::kConfirmed);
  EXPECT_EQ(estimate.rungs.size(), 7U);
  EXPECT_EQ(num_trusted(estimate), 7);
  const double gap_z_m = shape.first_height_m + 3 * shape.spacing_m;
  for (const Rung& rung : estimate.rungs) {
    EXPECT_GT(std::abs(0.5 * (rung.end0_m.z() + rung.end1_m.z()) - gap_z_m), 0.2);
  }
}

struct Damage {
  const char* name;
  void (*apply)(LadderShape&);
  unsigned flags;  ///< at least one of them
};

class DamagedRung : public testing::TestWithParam<Damage> {};

INSTANTIATE_TEST_SUITE_P(
    Kinds, DamagedRung,
    testing::Values(Damage{"stub", [](LadderShape& s) { s.stub_rung = 3; }, ladder::kFlagStub},
                    Damage{"bent", [](LadderShape& s) { s.bent_rung = 3; },
                           ladder::kFlagBent | ladder::kFlagSagged | ladder::kFlagStub},
                    Damage{"tilted", [](LadderShape& s) { s.tilted_rung = 3; },
                           ladder::kFlagTilted}),
    [](const auto& kind) { return std::string(kind.param.name); });

// A damaged rung stays visible with its flag, its neighbours without; stubs and bent ones are never
// offered.
TEST_P(DamagedRung, IsFlaggedAndNotOffered) {
  for (const double yaw_rad : {0.0, 0.3, -0.5}) {
    LadderShape shape;
    shape.yaw_rad = yaw_rad;
    GetParam().apply(shape);
    LadderScene scene(4);
    scene.add_ladder(shape);
    const LadderEstimate estimate = run(scene);
    ASSERT_EQ(estimate.state, LadderState::kConfirmed);
    const double damaged_z_m = shape.first_height_m + 3 * shape.spacing_m;
    int num_damaged = 0;
    for (int i = 0; i < static_cast<int>(estimate.rungs.size()); ++i) {
      const Rung& rung = estimate.rungs[i];
      const double off_m = 0.5 * (rung.end0_m.z() + rung.end1_m.z()) - damaged_z_m;
      if (std::abs(off_m) > 0.12) {
        EXPECT_EQ(rung.flags, 0);
        continue;
      }
      ++num_damaged;
      EXPECT_NE(rung.flags & GetParam().flags, 0U);
      if ((rung.flags & ladder::kFlagTilted) == rung.flags) continue;
      EXPECT_TRUE(std::none_of(estimate.grasps.begin(), estimate.grasps.end(),
                               [&](const auto& grasp) { return grasp.rung == i; }));
    }
    EXPECT_EQ(num_damaged, 1);
  }
}

// Every offered stretch lies on a sound rung, clear of the rails by the claw's width.
TEST(LadderScenes, OffersStayClearOfRailsAndDamage) {
  for (int kind = 0; kind < 4; ++kind) {
    LadderShape shape;
    shape.distance_m = 0.8;
    shape.yaw_rad = 0.2 * kind - 0.3;
    shape.stub_rung = kind == 1 ? 2 : -1;
    shape.bent_rung = kind == 2 ? 4 : -1;
    shape.rail_width_m = kind == 3 ? 0.04 : 0.01;
    LadderScene scene(20 + kind);
    scene.add_ladder(shape);
    const LadderEstimate estimate = run(scene, 2 * LadderParams{}.align.settle_frames);
    int num_offered = 0;
    for (const ladder::Interval& interval : estimate.intervals) {
      if (interval.reason != ladder::Reason::kNone) continue;
      ++num_offered;
      const Rung& rung = estimate.rungs[interval.rung];
      const Eigen::Vector3d d = (rung.end1_m - rung.end0_m).normalized();
      const Eigen::Vector3d from = rung.end0_m + interval.from_m * d;
      const Eigen::Vector3d to = rung.end0_m + interval.to_m * d;
      const bool sound =
          std::any_of(scene.truth.begin(), scene.truth.end(), [&](const RungTruth& truth) {
            const Eigen::Vector3d axis = (truth.end1_m - truth.end0_m).normalized();
            const Eigen::Vector3d w = from - truth.end0_m;
            return truth.is_sound && (w - w.dot(axis) * axis).norm() < 0.015 &&
                   w.dot(axis) > 0.030 && (truth.end1_m - to).dot(axis) > 0.030;
          });
      EXPECT_TRUE(sound) << "kind " << kind << ", rung " << rung.id;
    }
    EXPECT_GE(num_offered, 6);
  }
}

// Inclined ladders and other spacings, widths and diameters are found with the same parameters.
TEST(LadderScenes, FindsOtherShapes) {
  std::vector<LadderShape> shapes(7);
  shapes[0].tilt_rad = 0.17;
  shapes[1].tilt_rad = 0.52;
  shapes[2].spacing_m = 0.25;
  shapes[3].spacing_m = 0.356;
  shapes[4].clear_width_m = 0.30;
  shapes[5].clear_width_m = 0.58;
  shapes[6].rung_diameter_m = 0.035;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    LadderScene scene(30 + i);
    scene.add_ladder(shapes[i]);
    const LadderEstimate estimate = run(scene);
    EXPECT_EQ(estimate.state, LadderState::kConfirmed) << "shape " << i;
    EXPECT_EQ(num_trusted(estimate), 8) << "shape " << i;
    EXPECT_NEAR(estimate.spacing_m, shapes[i].spacing_m, 0.003);
  }
}

// Bars of 100 mm are rungs with their measured radius, unless the option says that they are none.
TEST(LadderScenes, ThickRungsAreMeasured) {
  LadderShape shape;
  shape.rung_diameter_m = 0.10;
  shape.rail_width_m = 0.04;
  shape.num_rungs = 5;
  LadderScene scene(9);
  scene.node_spacing_m = 0.02;
  scene.add_ladder(shape);
  LadderParams params;
  params.test.thick_rungs = false;
  LadderTracker without(params);
  for (int frame = 0; frame < 5; ++frame) {
    EXPECT_EQ(without.update(scene.cloud(frame)).state, LadderState::kNone);
  }
  const LadderEstimate estimate = run(scene, 5);
  EXPECT_EQ(estimate.state, LadderState::kConfirmed);
  for (const RungTruth& truth : scene.truth) {
    const Rung* rung = match(estimate, truth);
    ASSERT_NE(rung, nullptr);
    EXPECT_NEAR(rung->radius_m, 0.05, 0.006);
    EXPECT_LT((rung->end0_m - truth.end0_m).norm(), 0.02);
  }
}

struct Negative {
  const char* name;
  void (*build)(LadderScene&);
};

class NoLadder : public testing::TestWithParam<Negative> {};

INSTANTIATE_TEST_SUITE_P(
    Kinds, NoLadder,
    testing::Values(Negative{"stairs", [](LadderScene& s) { s.add_stairs(0.8, 6); }},
                    Negative{"shelf", [](LadderScene& s) { s.add_shelf(0.9); }},
                    Negative{"cupboard_front",
                             [](LadderScene& s) { s.add_front(0.9, 0.4, 0.1, 1.3, false); }},
                    Negative{"single_bar",
                             [](LadderScene& s) {
                               s.add_bar({1.0, 0.5, 0.9}, {1.0, -0.5, 0.9}, 0.03);
                             }},
                    Negative{"two_posts_one_bar",
                             [](LadderScene& s) {
                               s.add_bar({1.0, 0.3, 0.9}, {1.0, -0.3, 0.9}, 0.03);
                               s.add_bar({1.0, 0.3, 0.0}, {1.0, 0.3, 1.5}, 0.03);
                               s.add_bar({1.0, -0.3, 0.0}, {1.0, -0.3, 1.5}, 0.03);
                             }},
                    Negative{"steep_stairs_between_posts",
                             [](LadderScene& s) {
                               for (int i = 0; i < 7; ++i) {
                                 const double z_m = 0.2 + 0.19 * i;
                                 s.add_bar({1.0, 0.25, z_m}, {1.0, -0.25, z_m}, 0.03);
                               }
                               s.add_bar({1.0, 0.25, 0.0}, {1.0, 0.25, 1.6}, 0.03);
                               s.add_bar({1.0, -0.25, 0.0}, {1.0, -0.25, 1.6}, 0.03);
                             }},
                    Negative{"handrail",
                             [](LadderScene& s) {
                               s.add_bar({0.7, 0.4, 0.5}, {1.5, 0.4, 0.9}, 0.04);
                               for (int i = 0; i < 5; ++i) {
                                 const double x_m = 0.7 + 0.2 * i;
                                 s.add_bar({x_m, 0.4, 0.0}, {x_m, 0.4, 0.5 + 0.1 * i}, 0.02);
                               }
                             }}),
    [](const auto& kind) { return std::string(kind.param.name); });

// Nothing that is no ladder is ever confirmed, in any frame, and nothing on it is offered.
TEST_P(NoLadder, IsNeverConfirmed) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    LadderScene scene(seed);
    scene.node_spacing_m = 0.010 + 0.004 * static_cast<double>(seed);
    GetParam().build(scene);
    LadderTracker tracker{LadderParams{}};
    for (int frame = 0; frame < 8; ++frame) {
      const LadderEstimate& estimate = tracker.update(scene.cloud(frame));
      EXPECT_EQ(estimate.state, LadderState::kNone);
      EXPECT_TRUE(estimate.grasps.empty());
      for (const Rung& rung : estimate.rungs) EXPECT_EQ(rung.state, RungState::kCandidate);
    }
  }
}

// Boards of stairs, 80 mm high, are seen as bars with their height, one per step.
TEST(LadderScenes, StairsAreSeenAsBars) {
  for (const double height_m : {0.07, 0.08, 0.09}) {
    LadderScene scene(6);
    for (int i = 0; i < 6; ++i) {
      const double z_m = 0.19 * (i + 1);
      scene.add_board({0.8 + 0.25 * i, 0.45, z_m}, {0.8 + 0.25 * i, -0.45, z_m}, height_m);
    }
    const LadderEstimate estimate = run(scene, 4);
    ASSERT_EQ(estimate.rungs.size(), 6U);
    for (int i = 0; i < 6; ++i) {
      const Rung& bar = estimate.rungs[i];
      EXPECT_EQ(bar.state, RungState::kCandidate);
      EXPECT_NEAR(0.5 * (bar.end0_m.z() + bar.end1_m.z()), 0.19 * (i + 1), 0.02);
      EXPECT_NEAR(2.0 * bar.radius_m, height_m, 0.02);
    }
  }
}

// Ids stay with their rungs, and the averaged middle point grows more certain.
TEST(LadderScenes, IdsStayAndCertaintyGrows) {
  LadderScene scene(8);
  scene.add_ladder({});
  LadderTracker tracker{LadderParams{}};
  LadderEstimate first;
  for (int frame = 0; frame < 3; ++frame) first = tracker.update(scene.cloud(frame));
  for (int frame = 3; frame < 40; ++frame) {
    const LadderEstimate& now = tracker.update(scene.cloud(frame));
    ASSERT_EQ(now.rungs.size(), first.rungs.size());
    for (std::size_t i = 0; i < first.rungs.size(); ++i) {
      EXPECT_EQ(now.rungs[i].id, first.rungs[i].id);
    }
  }
  const LadderEstimate& last = tracker.update(scene.cloud(40));
  for (std::size_t i = 0; i < first.rungs.size(); ++i) {
    EXPECT_LT(last.rungs[i].covariance_m2.trace(), first.rungs[i].covariance_m2.trace());
    EXPECT_GT(last.rungs[i].covariance_m2.determinant(), 0.0);
    EXPECT_EQ(last.rungs[i].confidence, 1.0);
  }
}

}  // namespace
