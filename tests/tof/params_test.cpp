// SPDX-License-Identifier: BSD-3-Clause
// Parameters out of range are refused in words that name the field.
#include "tof/params.h"

#include <functional>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// The defaults are valid.
TEST(TofParams, DefaultsPass) {
  EXPECT_EQ(tof::check(tof::TofParams{}), "");
}

// Each field is checked, and the message names it.
TEST(TofParams, FaultsNameTheField) {
  struct Case {
    const char* field;
    std::function<void(tof::TofParams&)> spoil;
  };
  const Case cases[] = {
      {"filter.min_confidence", [](auto& p) { p.filter.min_confidence = 256; }},
      {"filter.flying_step_m", [](auto& p) { p.filter.flying_step_m = 0.0; }},
      {"filter.flying_step_ratio", [](auto& p) { p.filter.flying_step_ratio = 0.5; }},
      {"filter.white_half_confidence_m", [](auto& p) { p.filter.white_half_confidence_m = kNaN; }},
      {"heads.period_s", [](auto& p) { p.heads.period_s = 0.0; }},
      {"heads.awaited_at_start", [](auto& p) { p.heads.awaited_at_start = 0; }},
      {"heads.dead_periods", [](auto& p) { p.heads.dead_periods = 1.0; }},
      {"heads.backward_reset_s", [](auto& p) { p.heads.backward_reset_s = -1.0; }},
      {"heads.forward_reset_s", [](auto& p) { p.heads.forward_reset_s = kNaN; }},
      {"gravity.time_constant_s", [](auto& p) { p.gravity.time_constant_s = 0.0; }},
      {"gravity.gravity_m_s2", [](auto& p) { p.gravity.gravity_m_s2 = 0.0; }},
      {"gravity.trust_m_s2", [](auto& p) { p.gravity.trust_m_s2 = 9.9; }},
      {"gravity.max_gap_s", [](auto& p) { p.gravity.max_gap_s = 0.0; }},
      {"poses.capacity", [](auto& p) { p.poses.capacity = 1; }},
      {"poses.max_gap_s", [](auto& p) { p.poses.max_gap_s = 0.0; }},
      {"poses.max_extrapolation_s", [](auto& p) { p.poses.max_extrapolation_s = kNaN; }},
      {"max_points", [](auto& p) { p.max_points = 0; }},
  };
  for (const Case& c : cases) {
    tof::TofParams params;
    c.spoil(params);
    EXPECT_THAT(tof::check(params), testing::StartsWith(c.field));
  }
}

}  // namespace
