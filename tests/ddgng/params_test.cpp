// SPDX-License-Identifier: BSD-3-Clause
// Parameters are refused with the name of the field that breaks a relation.
#include "ddgng/params.h"

#include <limits>

#include <gmock/gmock.h>

#include "ddgng/strength.h"

namespace ddgng {
namespace {

using testing::HasSubstr;

// The defaults and the paper's numbers are sound.
TEST(GrowingParams, DefaultsHold) {
  EXPECT_EQ(check(GrowingParams{}), "");
  EXPECT_EQ(check(paper_params()), "");
}

// Each broken relation is named; NaN breaks every range.
TEST(GrowingParams, NamesTheField) {
  const auto broken = [](auto change) {
    GrowingParams params;
    change(params);
    return check(params);
  };
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(broken([](auto& p) { p.max_nodes = 1; }), HasSubstr("max_nodes"));
  EXPECT_THAT(broken([](auto& p) { p.max_nodes = 32769; }), HasSubstr("max_nodes"));
  EXPECT_THAT(broken([](auto& p) { p.max_boot_nodes = 1001; }), HasSubstr("max_boot_nodes"));
  EXPECT_THAT(broken([](auto& p) { p.max_degree = 32; }), HasSubstr("max_degree"));
  EXPECT_THAT(broken([](auto& p) { p.insertion_interval = 0; }), HasSubstr("insertion_interval"));
  EXPECT_THAT(broken([](auto& p) { p.plain_insertion_every = 0; }),
              HasSubstr("plain_insertion_every"));
  EXPECT_THAT(broken([](auto& p) { p.uniform_signals = -1; }), HasSubstr("uniform_signals"));
  EXPECT_THAT(broken([](auto& p) { p.neighbour_rate = 0.5F; }), HasSubstr("neighbour_rate"));
  EXPECT_THAT(broken([](auto& p) { p.winner_rate = kNan; }), HasSubstr("winner_rate"));
  EXPECT_THAT(broken([](auto& p) { p.error_decay = 1.0F; }), HasSubstr("error_decay"));
  EXPECT_THAT(broken([](auto& p) { p.strength_inside = 0.5F; }), HasSubstr("strength_inside"));
  EXPECT_THAT(broken([](auto& p) { p.moment_forget = kNan; }), HasSubstr("moment_forget"));
  EXPECT_THAT(broken([](auto& p) { p.utility_interval = 0; }), HasSubstr("utility_interval"));
}

// A node inside wins an insertion against one outside of 190 times its error (3.71^4).
TEST(Strength, WeightsInsertion) {
  const GrowingParams params;
  EXPECT_EQ(insertion_weight(params, false), 1.0F);
  EXPECT_NEAR(insertion_weight(params, true), 189.45F, 0.1F);
}

// Only the ratio of the strengths matters, and equal strengths weigh nothing.
TEST(Strength, RatioAlone) {
  GrowingParams params;
  params.strength_outside = 0.35F;
  params.strength_inside = 0.35F;
  EXPECT_EQ(insertion_weight(params, true), 1.0F);
  EXPECT_EQ(strength(params, true), 0.35F);
}

}  // namespace
}  // namespace ddgng
