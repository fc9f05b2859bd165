// SPDX-License-Identifier: BSD-3-Clause
// The search for another way where the crawl has no next step: a few places of the body a cycle, as
// a slow computer has to make it.
#include <gtest/gtest.h>

#include "climb/step_planner.h"
#include "tests/climb/controller_fixture.h"

namespace climb {
namespace {

using climb_tests::params;
using S = ControllerState;

/// It hangs below a rung that looks damaged: the first step over it needs another place.
class OtherWayTest : public climb_tests::ControllerFixture {
 protected:
  static constexpr int kMostCalls = 31;

  void SetUp() override {
    start_anew();
    ASSERT_TRUE(arm()) << where();
    stand_.rungs.at(5).damaged = true;
    order(Order::kClimb);
    for (int i = 0; i < 40'000 && output_.refusal != Refusal::kDamaged; ++i) cycle();
    ASSERT_EQ(output_.state, S::kClimbing) << where();
    for (const Leg leg : kLegs) {
      now_.stance.angles_rad[leg] = stand_.measured_rad(leg);
      now_.stance.contacts[leg] = {1.0, output_.rung_ids[leg]};
      now_.limbs[leg] = LimbState::kLoaded;
    }
    now_.pose = output_.pose;
    planner_.find_turn(now_);
    refused_ = planner_.next(true, true, now_, ladder());
    ASSERT_EQ(refused_.refusal, Refusal::kDamaged);
  }
  LadderView ladder() const { return {stand_.rungs, stand_.stretches, 0.05, true}; }
  std::optional<PlannedStep> look() { return planner_.over(refused_, true, now_, ladder()); }
  /// Calls until it answers; 0 = it does not.
  int calls_to_answer() {
    for (int i = 1; i <= kMostCalls; ++i) {
      if ((answer_ = look())) return i;
    }
    return 0;
  }

  RobotNow now_;
  StepPlanner planner_{params().climb};
  PlannedStep refused_;
  std::optional<PlannedStep> answer_;
};

// It takes several calls, but not more than a third of a second of them; the next search, of the
// same stance, finds the same.
TEST_F(OtherWayTest, AnswersAfterSomeCyclesAndAlwaysTheSame) {
  const int num_calls = calls_to_answer();
  ASSERT_GT(num_calls, 1);
  ASSERT_TRUE(answer_->ready);
  const PlannedStep first = *answer_;
  EXPECT_EQ(calls_to_answer(), num_calls);
  ASSERT_TRUE(answer_ && answer_->ready);
  EXPECT_EQ(answer_->leg, first.leg);
  EXPECT_EQ(answer_->goal.grasp_m, first.goal.grasp_m);
  EXPECT_EQ(answer_->move.shift_m, first.move.shift_m);
}

// Where there is none, it has looked at every stage's places, and says what was refused.
TEST_F(OtherWayTest, SaysWhatWasRefusedWhereThereIsNone) {
  for (RungView& rung : stand_.rungs) rung.damaged = true;
  EXPECT_GT(calls_to_answer(), 1);
  ASSERT_TRUE(answer_);
  EXPECT_FALSE(answer_->ready);
  EXPECT_EQ(answer_->refusal, Refusal::kDamaged);
}

// Broken off half way, it begins anew.
TEST_F(OtherWayTest, BeginsAnewWhenForgotten) {
  const int num_calls = calls_to_answer();
  ASSERT_GT(num_calls, 2);
  EXPECT_FALSE(look());
  planner_.forget_way();
  EXPECT_EQ(calls_to_answer(), num_calls);
}

// Nothing is looked for where there is a step, at the top, and when nothing is seen by now.
TEST_F(OtherWayTest, AnswersAtOnceWhereThereIsNothingToLookFor) {
  const auto answers_at_once = [&](PlannedStep wanted) {
    const std::optional<PlannedStep> answer = planner_.over(wanted, true, now_, ladder());
    return answer && answer->ready == wanted.ready && answer->refusal == wanted.refusal;
  };
  PlannedStep ready = refused_, top = refused_, stale = refused_;
  ready.ready = top.at_top = true;
  stale.refusal = Refusal::kStale;
  EXPECT_FALSE(look());
  EXPECT_TRUE(answers_at_once(ready));
  EXPECT_TRUE(answers_at_once(top));
  EXPECT_TRUE(answers_at_once(stale));
}

// The claws stay where they are all the while, and then the way that was found is gone.
TEST_F(OtherWayTest, TheRobotStandsWhileItLooks) {
  for (int i = 0; i < 300 && !controller_.limb(refused_.leg).moves(); ++i) {
    for (const Leg leg : kLegs) ASSERT_EQ(output_.limbs[leg], LimbState::kLoaded);
    cycle();
  }
  ASSERT_TRUE(reach(S::kHold, 400.0)) << where();
  EXPECT_TRUE(output_.at_top) << where();
}

}  // namespace
}  // namespace climb
