// SPDX-License-Identifier: BSD-3-Clause
// Scores of cases made by hand, of which the right answer is known.
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "simulator/score/scorer.h"
#include "tests/simulator/score_cases.h"

namespace simulator {
namespace {

using ladder_msgs::ladder_t;
using ladder_msgs::topology_t;
using ladder_msgs::truth_t;
using ::testing::ElementsAre;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// Nothing at all gives an empty score.
TEST(Scorer, Nothing) {
  const Score score = Scorer().result();
  EXPECT_FALSE(score.has_truth);
  EXPECT_EQ(score.frames, 0);
  EXPECT_FALSE(score.recall);
  EXPECT_FALSE(score.bars_m);
}

// A perfect report scores 1 everywhere, with errors of rounding alone.
TEST(Scorer, Perfect) {
  const Score score = score_of(truth(), report(perfect()));
  EXPECT_EQ(score.rungs_true, 3);
  EXPECT_EQ(score.rungs_confirmed, 3);
  EXPECT_EQ(score.recall, 1.0);
  EXPECT_EQ(score.precision, 1.0);
  EXPECT_EQ(score.false_ladders, 0);
  EXPECT_EQ(score.frames_to_first_rung, 1);
  EXPECT_EQ(score.frames_to_all_rungs, 1);
  EXPECT_LT(*score.axis_error_mm_p95, 1e-3);
  EXPECT_LT(*score.angle_error_deg_p50, 1e-3);
  EXPECT_LT(*score.end_error_mm_p50, 1e-3);
  EXPECT_EQ(score.end_errors_mm.size(), 6U);
}

// Reported from right to left is as good.
TEST(Scorer, EndsMayBeSwapped) {
  std::vector<Bar> bars = perfect();
  for (Bar& bar : bars) std::swap(bar.end0_m, bar.end1_m);
  const Score score = score_of(truth(), report(bars));
  EXPECT_EQ(score.recall, 1.0);
  EXPECT_LT(*score.end_error_mm_p95, 1e-3);
}

// No report: nothing found, and precision has no meaning.
TEST(Scorer, EmptyReport) {
  const Score score = score_of(truth(), report({}));
  EXPECT_EQ(score.recall, 0.0);
  EXPECT_FALSE(score.precision);
  EXPECT_FALSE(score.axis_error_mm_p50);
  EXPECT_FALSE(score.frames_to_first_rung);
}

// The table of limits: just inside matches, just outside is wrong.
TEST(Scorer, MatchLimits) {
  struct Case {
    const char* name;
    Eigen::Vector3d by_m;
    double turn_deg;
    bool matches;
  };
  for (const Case& c : {Case{"49 mm too far", {0.049, 0.0, 0.0}, 0.0, true},
                        Case{"51 mm too far", {0.051, 0.0, 0.0}, 0.0, false},
                        Case{"51 mm too high", {0.0, 0.0, 0.051}, 0.0, false},
                        Case{"40 mm in both", {0.04, 0.0, 0.04}, 0.0, false},
                        Case{"0.19 m along", {0.0, 0.19, 0.0}, 0.0, true},
                        Case{"0.21 m along", {0.0, 0.21, 0.0}, 0.0, false},
                        Case{"14.9 deg", {0.0, 0.0, 0.0}, 14.9, true},
                        Case{"15.1 deg", {0.0, 0.0, 0.0}, 15.1, false},
                        Case{"165.1 deg", {0.0, 0.0, 0.0}, 165.1, true}}) {
    Bar bar = rung_at(0.6);
    const Eigen::Vector3d middle = bar.middle_m();
    const Eigen::AngleAxisd turn(c.turn_deg * M_PI / 180.0, Eigen::Vector3d::UnitX());
    bar.end0_m = middle + turn * (bar.end0_m - middle) + c.by_m;
    bar.end1_m = middle + turn * (bar.end1_m - middle) + c.by_m;
    const Score score = score_of(truth(), report({bar}));
    EXPECT_EQ(score.precision, c.matches ? 1.0 : 0.0) << c.name;
    EXPECT_NEAR(*score.recall, c.matches ? 1.0 / 3.0 : 0.0, 1e-12) << c.name;
  }
}

// Errors are measured: 3 mm too far and 4 mm too high are 5 mm from the axis, 3 of them in depth.
TEST(Scorer, ErrorsInNumbers) {
  std::vector<Bar> bars = perfect();
  for (Bar& bar : bars) bar = moved(bar, {0.003, 0.007, 0.004});
  const Score score = score_of(truth(), report(bars));
  EXPECT_NEAR(*score.axis_error_mm_p50, 5.0, 1e-3);
  EXPECT_NEAR(*score.axis_error_mm_p95, 5.0, 1e-3);
  EXPECT_NEAR(*score.depth_error_mm_p50, 3.0, 1e-3);
  EXPECT_NEAR(*score.end_error_mm_p50, 7.0, 1e-3);
}

// The same rung reported twice is found once and wrong once; the nearer one counts.
TEST(Scorer, Duplicate) {
  std::vector<Bar> bars = perfect();
  bars.insert(bars.begin(), moved(bars[1], {0.02, 0.0, 0.0}));
  const Score score = score_of(truth(), report(bars));
  EXPECT_EQ(score.recall, 1.0);
  EXPECT_EQ(score.precision, 0.75);
  EXPECT_EQ(score.rungs_wrong, 1);
  EXPECT_LT(*score.axis_error_mm_p95, 1e-3);
}

// Numbers that are none, and a rung without length, are wrong rungs and spoil nothing else.
TEST(Scorer, NanAndPoint) {
  std::vector<Bar> bars = perfect();
  bars.push_back({{kNan, 0.0, 0.0}, {1.0, 0.0, 0.0}});
  bars.push_back({{1.0, 0.0, 0.6}, {1.0, 0.0, 0.6}});
  bars.push_back({{1.0, 0.0, HUGE_VAL}, {1.0, 0.0, 0.6}});
  const Score score = score_of(truth(), report(bars));
  EXPECT_EQ(score.recall, 1.0);
  EXPECT_EQ(score.precision, 0.5);
  EXPECT_TRUE(std::isfinite(*score.axis_error_mm_p95));
}

// A count that promises more than the arrays hold is not believed.
TEST(Scorer, CountsThatLie) {
  ladder_t ladder = report(perfect());
  ladder.num_rungs = 1000;
  EXPECT_EQ(score_of(truth(), ladder).rungs_confirmed, 3);
  ladder.num_rungs = -1;
  EXPECT_EQ(score_of(truth(), ladder).rungs_confirmed, 0);
}

// A rung that could hardly be seen is not missed, and reporting it is not wrong.
TEST(Scorer, UnseenRungsAreIgnored) {
  truth_t seen = truth();
  seen.rung_hits[2] = 39;
  seen.rung_visible[1] = 0.55F;
  const Score score = score_of(seen, report(perfect()));
  EXPECT_EQ(score.rungs_true, 1);
  EXPECT_EQ(score.recall, 1.0);
  EXPECT_EQ(score.precision, 1.0);
  EXPECT_EQ(score_of(seen, report({rung_at(0.3)})).recall, 1.0);
}

// Forty hits over 60 % are enough.
TEST(Scorer, CountableFromFortyHits) {
  truth_t seen = truth();
  seen.rung_hits = {40, 39, 40};
  seen.rung_visible = {0.6F, 1.0F, 0.59F};
  EXPECT_EQ(score_of(seen, report(perfect())).rungs_true, 1);
}

// A bent rung counts for recall, not for the errors.
TEST(Scorer, BentRungsHaveNoAxisError) {
  truth_t bent = truth();
  bent.rung_kind = {truth_t::RUNG_BENT, truth_t::RUNG_BENT, truth_t::RUNG_BENT};
  const Score score = score_of(bent, report(perfect()));
  EXPECT_EQ(score.recall, 1.0);
  EXPECT_FALSE(score.axis_error_mm_p50);
}

// The ends of a rung that is partly out of view are not judged.
TEST(Scorer, EndsOutOfViewAreNotJudged) {
  truth_t seen = truth();
  seen.rung_visible = {0.9F, 0.9F, 1.0F};
  EXPECT_EQ(score_of(seen, report(perfect())).end_errors_mm.size(), 2U);
}

// Candidates are counted apart and are never wrong.
TEST(Scorer, CandidatesAreNotConfirmed) {
  ladder_t ladder = report({rung_at(0.3), rung_at(1.7)});
  ladder.rung_state = {ladder_t::RUNG_CANDIDATE, ladder_t::RUNG_CANDIDATE};
  const Score score = score_of(truth(), ladder);
  EXPECT_EQ(score.rungs_candidates, 2);
  EXPECT_EQ(score.rungs_confirmed, 0);
  EXPECT_EQ(score.recall, 0.0);
  EXPECT_FALSE(score.precision);
}

// In a scene without a ladder every frame with a confirmed ladder is counted, and its bars are no
// rungs.
TEST(Scorer, FalseLadders) {
  truth_t negative = truth();
  negative.is_ladder = 0;
  negative.rung_kind = {truth_t::RUNG_BAR, truth_t::RUNG_BAR, truth_t::RUNG_BAR};
  Scorer scorer;
  scorer.add(negative);
  for (int i = 0; i < 5; ++i) scorer.add(report(i % 2 == 0 ? perfect() : std::vector<Bar>{}));
  const Score score = scorer.result();
  EXPECT_EQ(score.false_ladders, 3);
  EXPECT_EQ(score.rungs_true, 0);
  EXPECT_FALSE(score.recall);
  EXPECT_EQ(score.precision, 0.0);
}

// A ladder confirmed beside the real one is false, too.
TEST(Scorer, LadderInTheWrongPlace) {
  EXPECT_EQ(score_of(truth(), report({rung_at(1.5), rung_at(1.8)})).false_ladders, 1);
}

// Frames are counted from 1, and the last one decides recall.
TEST(Scorer, FramesToRungs) {
  Scorer scorer;
  for (std::int64_t utime = 0; utime < 5; ++utime) scorer.add(truth(utime));
  scorer.add(report({}, 0));
  scorer.add(report({rung_at(0.3)}, 1));
  scorer.add(report(perfect(), 2));
  scorer.add(report({rung_at(0.3)}, 3));
  const Score score = scorer.result();
  EXPECT_EQ(score.frames, 4);
  EXPECT_EQ(score.frames_to_first_rung, 2);
  EXPECT_EQ(score.frames_to_all_rungs, 3);
  EXPECT_NEAR(*score.recall, 1.0 / 3.0, 1e-12);
  EXPECT_NEAR(*score.recall_all_frames, 5.0 / 12.0, 1e-12);
}

// A report is compared with the truth of its own time, also when that arrives later.
TEST(Scorer, TruthNearestInTime) {
  truth_t later = truth(200);
  for (float& z : later.rung_z0_m) z += 0.15F;
  for (float& z : later.rung_z1_m) z += 0.15F;
  Scorer scorer;
  scorer.add(report(perfect(), 110));
  scorer.add(later);
  scorer.add(truth(100));
  EXPECT_EQ(scorer.result().recall, 1.0);
}

topology_t topology() {
  topology_t message{};
  message.utime = 100;
  message.num_nodes = 4;
  message.node_x_m = {1.0F, 1.0F, 1.0F, 1.06F};
  message.node_y_m = {0.0F, 0.205F, 0.0F, 0.0F};
  message.node_z_m = {0.31F, 1.5F, 1.5F, 0.3F};
  message.node_class = {topology_t::CLASS_OBSTACLE, topology_t::CLASS_OBSTACLE,
                        topology_t::CLASS_WALL, topology_t::CLASS_UNKNOWN};
  message.label_class = {topology_t::CLASS_SAFE_GROUND, topology_t::CLASS_WALL,
                         topology_t::CLASS_SAFE_GROUND};
  message.label_area_m2 = {1.5F, 2.0F, 0.25F};
  return message;
}

// Nodes count as on the ladder within 50 mm of a rung or rail.
TEST(Scorer, NodesOnTheLadder) {
  Scorer scorer;
  scorer.add(truth());
  scorer.add(report({}));
  scorer.add(topology());
  const Score score = scorer.result();
  EXPECT_EQ(score.nodes, 4);
  EXPECT_EQ(score.nodes_on_ladder_share, 0.5);
  EXPECT_EQ(score.nodes_obstacle, 2);
  EXPECT_EQ(score.floor_area_m2, 1.75);
  EXPECT_EQ(score.wall_area_m2, 2.0);
}

// Bars are measured from the lowest level plane, candidates included; without a plane there is no
// height.
TEST(Scorer, BarsAboveTheFloor) {
  Scorer scorer;
  ladder_t ladder = report({rung_at(0.6), rung_at(0.3)});
  ladder.rung_state[0] = ladder_t::RUNG_CANDIDATE;
  scorer.add(ladder);
  scorer.add(topology());
  EXPECT_FALSE(scorer.result().bars_m);
  topology_t with_floor = topology();
  with_floor.num_planes = 2;
  with_floor.plane_normal_x = {0.0F, 0.0F};
  with_floor.plane_normal_y = {0.0F, 0.0F};
  with_floor.plane_normal_z = {1.0F, 1.0F};
  with_floor.plane_offset_m = {-0.1F, -0.5F};
  with_floor.plane_class = {topology_t::CLASS_SAFE_GROUND, topology_t::CLASS_SAFE_GROUND};
  scorer.add(with_floor);
  ASSERT_TRUE(scorer.result().bars_m);
  EXPECT_THAT(*scorer.result().bars_m,
              ElementsAre(::testing::DoubleNear(0.8, 1e-6), ::testing::DoubleNear(1.1, 1e-6)));
}

}  // namespace
}  // namespace simulator
