// SPDX-License-Identifier: BSD-3-Clause
// What is offered to a claw, identities and removals, judged on cases made by hand.
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "simulator/score/scorer.h"
#include "tests/simulator/score_cases.h"

namespace simulator {
namespace {

using ladder_msgs::ladder_t;
using ladder_msgs::truth_t;

/// The perfect report that offers [from, to] of its lowest rung.
ladder_t offering(float from_m, float to_m, std::uint8_t reason = ladder_t::REASON_NONE) {
  ladder_t message = report(perfect());
  message.num_intervals = 1;
  message.interval_rung = {0};
  message.interval_from_m = {from_m};
  message.interval_to_m = {to_m};
  message.interval_reason = {reason};
  return message;
}

int num_unsafe(const truth_t& true_scene, const ladder_t& message) {
  return score_of(true_scene, message).unsafe_grasps;
}

// A claw's width from both ends is safe, a millimetre nearer to one of them is not; a refused
// stretch is no offer.
TEST(Offers, KeepAClawsWidthFromTheEnds) {
  EXPECT_EQ(score_of(truth(), offering(0.035F, 0.365F)).grasps_offered, 1);
  EXPECT_EQ(num_unsafe(truth(), offering(0.035F, 0.365F)), 0);
  EXPECT_EQ(num_unsafe(truth(), offering(0.033F, 0.365F)), 1);
  EXPECT_EQ(num_unsafe(truth(), offering(0.035F, 0.367F)), 1);
  EXPECT_EQ(score_of(truth(), offering(0.0F, 0.4F, ladder_t::REASON_RAIL_TOO_NEAR)).grasps_offered,
            0);
}

// The same stretch is unsafe on a bent rung, a stub, a bar of no ladder, and where nothing is.
TEST(Offers, OnlyOnSoundRungs) {
  for (const std::int8_t kind :
       {truth_t::RUNG_BENT, truth_t::RUNG_STUB, truth_t::RUNG_BAR, truth_t::RUNG_UNKNOWN}) {
    truth_t damaged = truth();
    damaged.rung_kind[0] = static_cast<std::uint8_t>(kind);
    EXPECT_EQ(num_unsafe(damaged, offering(0.1F, 0.3F)), 1) << static_cast<int>(kind);
  }
  truth_t no_ladder = truth();
  no_ladder.is_ladder = 0;
  EXPECT_EQ(num_unsafe(no_ladder, offering(0.1F, 0.3F)), 1);
  truth_t moved_away = truth();
  moved_away.rung_z0_m[0] = moved_away.rung_z1_m[0] = 0.36F;
  EXPECT_EQ(num_unsafe(moved_away, offering(0.1F, 0.3F)), 1);
}

// Grasps are judged as single places; one that is not a number is unsafe.
TEST(Offers, GraspsCountToo) {
  ladder_t message = report(perfect());
  message.num_grasps = 2;
  message.grasp_rung = {0, 0};
  message.grasp_x_m = {1.0F, std::numeric_limits<float>::quiet_NaN()};
  message.grasp_y_m = {0.0F, 0.0F};
  message.grasp_z_m = {0.3F, 0.3F};
  const Score score = score_of(truth(), message);
  EXPECT_EQ(score.grasps_offered, 2);
  EXPECT_EQ(score.unsafe_grasps, 1);
}

// An interval of a rung that does not exist is not followed.
TEST(Offers, WrongIndexIsNoOffer) {
  ladder_t message = offering(0.1F, 0.3F);
  message.interval_rung = {77};
  EXPECT_EQ(score_of(truth(), message).grasps_offered, 0);
  message.interval_rung = {-1};
  EXPECT_EQ(score_of(truth(), message).grasps_offered, 0);
}

// The reported radius is compared with the true one, as a share of it.
TEST(Scorer, RadiusErrorIsAShare) {
  ladder_t message = report(perfect());
  message.rung_radius_m = {0.0154F, 0.014F, 0.007F};
  const Score score = score_of(truth(), message);
  EXPECT_NEAR(score.radius_errors[0], 0.1, 1e-4);
  EXPECT_NEAR(score.radius_errors[1], 0.0, 1e-4);
  EXPECT_NEAR(score.radius_errors[2], 0.5, 1e-4);
}

// A true rung that goes on under another id is one switch; one that is only lost for a while keeps
// its id and is none.
TEST(Identities, SwitchesAreCounted) {
  Scorer scorer;
  for (const std::int64_t t : {100, 200, 300, 400}) scorer.add(truth(t));
  scorer.add(report(perfect(), 100));
  scorer.add(report({}, 200));
  scorer.add(report(perfect(), 300));
  EXPECT_EQ(scorer.result().identity_switches, 0);
  ladder_t other = report(perfect(), 400);
  other.rung_id[1] = 9;
  scorer.add(other);
  EXPECT_EQ(scorer.result().identity_switches, 1);
}

// A rung taken away is noticed when none is reported there; offering it for a second more is the
// same fault and not counted twice, later it is unsafe.
TEST(Removals, AreTimed) {
  truth_t after = truth(1'000'000);
  after.num_rungs = 2;
  for (auto* column :
       {&after.rung_x0_m, &after.rung_y0_m, &after.rung_z0_m, &after.rung_x1_m, &after.rung_y1_m,
        &after.rung_z1_m, &after.rung_radius_m, &after.rung_visible}) {
    column->erase(column->begin());
  }
  after.rung_id.erase(after.rung_id.begin());
  after.rung_kind.erase(after.rung_kind.begin());
  after.rung_hits.erase(after.rung_hits.begin());
  Scorer scorer;
  scorer.add(truth(0));
  scorer.add(after);
  after.utime = 2'500'000;
  scorer.add(after);
  for (const std::int64_t t : {0, 1'000'000, 1'800'000}) {
    ladder_t message = offering(0.1F, 0.3F);
    message.utime = t;
    scorer.add(message);
  }
  EXPECT_EQ(scorer.result().rungs_removed, 1);
  EXPECT_TRUE(scorer.result().removals_noticed_s.empty());
  EXPECT_EQ(scorer.result().unsafe_grasps, 0);
  ladder_t late = offering(0.1F, 0.3F);
  late.utime = 2'400'000;
  scorer.add(late);
  EXPECT_EQ(scorer.result().unsafe_grasps, 1);
  scorer.add(report({rung_at(0.6), rung_at(0.9)}, 2'500'000));
  EXPECT_THAT(scorer.result().removals_noticed_s, ::testing::ElementsAre(1.5));
}

}  // namespace
}  // namespace simulator
