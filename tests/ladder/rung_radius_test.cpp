// SPDX-License-Identifier: BSD-3-Clause
// How thick a ladder's rungs are told to be, and whether they are round or square.
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "ladder/bar_detector.h"
#include "ladder/bar_tracker.h"
#include "ladder/ladder.h"
#include "tests/support/ladder_scene.h"

namespace {

using ladder::LadderParams;
using test_support::LadderScene;
using test_support::LadderShape;

constexpr int kNumFrames = 20;

/// Radii of a ladder's rungs, of one frame after so many; [m], ascending.
std::vector<double> radii_m(const LadderScene& scene, bool may_be_square = true) {
  LadderParams params;
  params.measure.square_rungs = may_be_square;
  ladder::BarDetector detector(params);
  std::vector<double> radii_m;
  for (int frame = 0; frame < kNumFrames; ++frame) {
    const ladder::Detections& found = detector.detect(scene.cloud(frame));
    radii_m.clear();
    for (const ladder::MeasuredBar& bar : found.bars) {
      if (bar.on_ladder) radii_m.push_back(bar.radius_m);
    }
  }
  std::sort(radii_m.begin(), radii_m.end());
  return radii_m;
}

// The straight rungs' radius is told of all: not that of a bent one, as thick as its bend is high,
// of which more is seen than of the others together.
TEST(RungRadius, ABentRungDoesNotTellTheOthersRadius) {
  constexpr int kBent = 1;
  LadderShape shape;
  shape.num_rungs = 3;
  shape.missing_rung = kBent;
  LadderScene scene(12);
  scene.add_ladder(shape);
  const Eigen::Vector3d left_m = scene.truth.front().end0_m;
  const Eigen::Vector3d right_m = scene.truth.front().end1_m;
  const Eigen::Vector3d up_m = kBent * shape.spacing_m * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d middle_m = 0.5 * (left_m + right_m) - 0.028 * Eigen::Vector3d::UnitZ();
  for (int times = 0; times < 3; ++times) {
    scene.add_bar(left_m + up_m, middle_m + up_m, shape.rung_diameter_m);
    scene.add_bar(middle_m + up_m, right_m + up_m, shape.rung_diameter_m);
  }
  const std::vector<double> told_m = radii_m(scene);
  ASSERT_EQ(told_m.size(), 3U);
  const double radius_m = 0.5 * shape.rung_diameter_m;
  EXPECT_NEAR(told_m.front(), radius_m, 0.15 * radius_m);
  EXPECT_NEAR(told_m.back(), radius_m, 0.15 * radius_m);
}

/// Of the rungs that are alike, after so many frames more; [m].
double last_radius_m(ladder::BarDetector& detector, const LadderScene& scene, int num_frames) {
  double radius_m = 0.0;
  for (int frame = 0; frame < num_frames; ++frame) {
    for (const ladder::MeasuredBar& bar : detector.detect(scene.cloud(frame)).bars) {
      if (bar.on_ladder && bar.is_alike) radius_m = bar.radius_m;
    }
  }
  return radius_m;
}

// Rungs do not become thin: once seen for long, they keep their radius when less of their height is
// seen, in the detector and in the tracks. Another ladder, in another place or after a reset, has
// its own.
TEST(RungRadius, WhatLooksThinnerIsHidden) {
  const auto ladder_of = [](double diameter_m, double distance_m) {
    LadderShape shape;
    shape.rung_diameter_m = diameter_m;
    shape.distance_m = distance_m;
    LadderScene scene(12);
    scene.add_ladder(shape);
    return scene;
  };
  const LadderScene before = ladder_of(0.030, 1.0);
  const LadderScene hidden = ladder_of(0.022, 1.0);
  ladder::BarDetector detector(LadderParams{});
  const double radius_m = last_radius_m(detector, before, 110);
  EXPECT_NEAR(radius_m, 0.015, 0.002);
  EXPECT_NEAR(last_radius_m(detector, hidden, 30), radius_m, 0.05 * radius_m);
  EXPECT_LT(last_radius_m(detector, ladder_of(0.022, 0.7), 30), 0.8 * radius_m);
  last_radius_m(detector, before, 110);
  detector.reset();
  EXPECT_LT(last_radius_m(detector, hidden, 30), 0.75 * radius_m);

  // One rung alone, and by more than rungs differ: of another kind it would be, had it not been
  // seen like the others.
  ladder::BarTracker tracker(LadderParams{});
  ladder::MeasuredBar bar;
  bar.end0_m = {1.0, 0.2, 0.5};
  bar.end1_m = {1.0, -0.2, 0.5};
  bar.on_ladder = bar.is_alike = true;
  bar.radius_m = 0.014;
  for (int frame = 0; frame < 10; ++frame) tracker.update(std::vector{bar});
  bar.is_alike = false;
  bar.radius_m = 0.005;
  for (int frame = 0; frame < 50; ++frame) tracker.update(std::vector{bar});
  ASSERT_EQ(tracker.tracks().size(), 1U);
  EXPECT_EQ(tracker.tracks()[0].bar.radius_m, 0.014);
  bar.radius_m = 0.040;
  for (int frame = 0; frame < 50; ++frame) tracker.update(std::vector{bar});
  EXPECT_NEAR(tracker.tracks()[0].bar.radius_m, 0.040, 0.001);
}

LadderScene ladder_at(double distance_m, bool is_square) {
  LadderShape shape;
  shape.distance_m = distance_m;
  if (is_square) shape.tread_depth_m = shape.rung_diameter_m;
  LadderScene scene(12);
  scene.add_ladder(shape);
  return scene;
}

constexpr double kHalfSide_m = 0.5 * 0.028;
constexpr double kWell_m = 0.15 * kHalfSide_m;

// Whether a ladder's rungs are square is settled in its first hundred frames: when the robot climbs
// it, round ones may look so. Another ladder, after a reset, is looked at anew.
TEST(RungRadius, ASectionIsSettled) {
  const LadderScene square = ladder_at(0.8, true);
  ladder::BarDetector detector(LadderParams{});
  EXPECT_NEAR(last_radius_m(detector, ladder_at(0.8, false), 110), kHalfSide_m, kWell_m);
  EXPECT_GT(last_radius_m(detector, square, 30), 1.1 * kHalfSide_m);
  detector.reset();
  EXPECT_NEAR(last_radius_m(detector, square, 30), kHalfSide_m, kWell_m);
}

// Of square rungs two faces show, half of the height is more than half of the side: told so where
// none are square by configuration; else within 15 %. Round ones stay as they are, to the bit.
// Neither is held to be a board.
TEST(RungRadius, OfSquareRungsIsHalfTheirSide) {
  const LadderScene round = ladder_at(0.8, false);
  EXPECT_EQ(radii_m(round, false), radii_m(round, true));

  const LadderScene square = ladder_at(0.8, true);
  const std::vector<double> as_round_m = radii_m(square, false);
  const std::vector<double> as_square_m = radii_m(square, true);
  ASSERT_GE(as_round_m.size(), 4U);
  ASSERT_EQ(as_square_m.size(), as_round_m.size());
  EXPECT_GT(as_round_m[as_round_m.size() / 2], 1.1 * kHalfSide_m);
  EXPECT_NEAR(as_square_m[as_square_m.size() / 2], kHalfSide_m, kWell_m);

  ladder::LadderTracker tracker{LadderParams{}};
  ladder::LadderEstimate estimate;
  for (int frame = 0; frame < kNumFrames; ++frame) estimate = tracker.update(square.cloud(frame));
  EXPECT_FALSE(estimate.grasps.empty());
}

// From the dock few rungs are seen whole, and round ones have looked square: so near nothing is
// held to be square, to the bit. What was seen from farther away stays.
TEST(RungRadius, ASectionIsNotJudgedFromNear) {
  const LadderScene near = ladder_at(0.35, true);
  ASSERT_GE(radii_m(near).size(), 3U);
  EXPECT_EQ(radii_m(near, true), radii_m(near, false));

  ladder::BarDetector detector(LadderParams{});
  last_radius_m(detector, ladder_at(0.55, true), 30);
  EXPECT_NEAR(last_radius_m(detector, near, 30), kHalfSide_m, kWell_m);
}

}  // namespace
