// SPDX-License-Identifier: BSD-3-Clause
#include "ddgng/structure_params.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace ddgng {
namespace {

using testing::HasSubstr;

// Both documented settings are in range.
TEST(StructureParams, DefaultAndPaperSettingsAreSound) {
  EXPECT_EQ(check(StructureParams()), "");
  EXPECT_EQ(check(paper_structure_params()), "");
}

// A broken relation is reported with the name of its field.
TEST(StructureParams, CheckNamesTheField) {
  StructureParams params;
  params.segment_angle_deg = 90.0F;
  EXPECT_THAT(check(params), HasSubstr("segment_angle_deg"));
  params = StructureParams();
  params.large_area_m2 = 0.001F;
  EXPECT_THAT(check(params), HasSubstr("large_area_m2"));
  params = StructureParams();
  params.refit_planes = false;
  EXPECT_THAT(check(params), HasSubstr("refit_planes"));
}

// Not-a-number never passes as a parameter.
TEST(StructureParams, NanIsOutOfRange) {
  StructureParams params;
  params.plane_min_support = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(check(params), HasSubstr("plane_min_support"));
  params = StructureParams();
  params.floor_height_m = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(check(params), HasSubstr("floor_height_m"));
}

// The series agrees with the standard library over its whole range.
TEST(StructureParams, CosineOfDegreesIsExactEnough) {
  for (double angle_deg = 0.0; angle_deg <= 180.0; angle_deg += 0.25) {
    EXPECT_NEAR(cosine_of_degrees(angle_deg), std::cos(angle_deg * std::numbers::pi / 180.0), 1e-15)
        << angle_deg;
  }
}

}  // namespace
}  // namespace ddgng
