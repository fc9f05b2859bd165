// SPDX-License-Identifier: BSD-3-Clause
// Parameters: the defaults hold together, and what does not is named.
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "ladder/ladder.h"

namespace {

using ladder::LadderParams;

template <class Spoil>
std::string violated(Spoil spoil) {
  LadderParams params;
  spoil(params);
  return ladder::check(params);
}

// Both built-in sets are usable.
TEST(LadderParams, BuiltInSetsHoldTogether) {
  EXPECT_EQ(ladder::check(LadderParams{}), "");
  EXPECT_EQ(ladder::check(ladder::paper_params()), "");
  EXPECT_EQ(ladder::paper_params().mode, ladder::Mode::kPaper);
}

// A violated relation names the field.
TEST(LadderParams, NamesTheViolatedField) {
  const auto names = [](const std::string& words, const char* field) {
    return words.find(field) != std::string::npos;
  };
  EXPECT_TRUE(names(violated([](auto& p) { p.max_tracks = 257; }), "max_tracks"));
  EXPECT_TRUE(names(violated([](auto& p) { p.bar.gap_m = 0.0; }), "bar.gap_m"));
  EXPECT_TRUE(names(violated([](auto& p) { p.bar.upright_min_dz = 0.1; }), "bar.upright_min_dz"));
  EXPECT_TRUE(names(violated([](auto& p) { p.test.min_rungs = 2; }), "test.min_rungs"));
  EXPECT_TRUE(names(violated([](auto& p) { p.test.min_spacing_m = 0.5; }), "test.min_spacing_m"));
  EXPECT_TRUE(names(violated([](auto& p) { p.test.tread_to_m = 0.04; }), "test.tread_from_m"));
  EXPECT_TRUE(
      names(violated([](auto& p) { p.track.trust_evidence = 13; }), "track.trust_evidence"));
  EXPECT_TRUE(names(violated([](auto& p) { p.affordance.step_m = 0.0; }), "affordance.step_m"));
  EXPECT_TRUE(names(violated([](auto& p) { p.paper.inlier_m = 0.02; }), "paper.inlier_m"));
}

// NaN violates.
TEST(LadderParams, NanViolates) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(violated([&](auto& p) { p.bar.gap_m = nan; }), "");
  EXPECT_NE(violated([&](auto& p) { p.affordance.claw_width_m = nan; }), "");
}

// A tracker is never built on parameters that contradict each other.
TEST(LadderParamsDeathTest, TrackerRefusesContradictions) {
  LadderParams params;
  params.max_tracks = 0;
  EXPECT_DEATH(ladder::LadderTracker{params}, "ladder parameters");
}

}  // namespace
