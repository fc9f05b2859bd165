// SPDX-License-Identifier: BSD-3-Clause
// Radians and counts: rounding, limits, signs, and numbers that are none.
#include "can/axis_config.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/rng.h"

namespace can {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

AxisConfig axis_of(double counts_per_rad) {
  AxisConfig axis;
  axis.node_id = 1;
  axis.counts_per_rad = counts_per_rad;
  return axis;
}

// Nearest count, halves up, for both signs.
TEST(AxisUnits, RoundsToTheNearest) {
  AxisConfig axis = axis_of(10.0);
  EXPECT_EQ(counts_from_rad(axis, 0.149), 1);
  EXPECT_EQ(counts_from_rad(axis, 0.151), 2);
  EXPECT_EQ(counts_from_rad(axis, 0.25), 3);
  EXPECT_EQ(counts_from_rad(axis, -0.25), -2);
  axis.sign = -1;
  EXPECT_EQ(counts_from_rad(axis, 0.149), -1);
  axis.offset_rad = 1.0;
  EXPECT_EQ(counts_from_rad(axis, 1.0), 0);
  EXPECT_EQ(counts_from_rad(axis, 2.0), -10);
  axis.gear = 9.0;
  EXPECT_EQ(counts_from_rad(axis, 2.0), -90);
}

// Counts -> radians -> counts is the same count, a million times, for any gear, sign and offset.
TEST(AxisUnits, CountsComeBack) {
  base::Rng rng(7);
  for (int i = 0; i < 1'000'000; ++i) {
    AxisConfig axis = axis_of(100.0 + 1e5 * rng.uniform());
    axis.gear = 1.0 + 100.0 * rng.uniform();
    axis.sign = rng.below(2) == 0 ? 1 : -1;
    axis.offset_rad = 6.0 * rng.uniform() - 3.0;
    const auto counts = static_cast<std::int32_t>(rng.next() >> 34) - (1 << 29);
    const auto again = counts_from_rad(axis, rad_from_counts(axis, counts));
    ASSERT_TRUE(again);
    ASSERT_LE(std::abs(*again - counts), 1);
  }
}

// What is not finite or does not fit is refused at the very edge, not one count earlier.
TEST(AxisUnits, RefusesWhatDoesNotFit) {
  const AxisConfig axis = axis_of(1.0);
  EXPECT_EQ(counts_from_rad(axis, 2147483647.0), 2147483647);
  EXPECT_EQ(counts_from_rad(axis, -2147483648.0), INT32_MIN);
  EXPECT_FALSE(counts_from_rad(axis, 2147483648.0));
  EXPECT_FALSE(counts_from_rad(axis, -2147483649.0));
  for (const double bad : {kNan, kInfinity, -kInfinity, 1e300, -1e300}) {
    EXPECT_FALSE(counts_from_rad(axis, bad));
    EXPECT_FALSE(permille_from_Nm(axis, bad));
  }
  for (const double bad : {kNan, -kInfinity, -1.0}) {
    EXPECT_FALSE(limit_counts(axis, bad));
    EXPECT_FALSE(limit_permille(axis, bad));
  }
  EXPECT_FALSE(limit_counts(axis, 1e10));
}

// A limit is rounded down, a torque to the nearest; the largest limit saturates.
TEST(AxisUnits, LimitsNeverGrow) {
  AxisConfig axis = axis_of(1000.0);
  axis.rated_torque_Nm = 10.0;
  EXPECT_EQ(limit_counts(axis, 1.9999), 1999U);
  EXPECT_EQ(limit_permille(axis, 1.9999), 199);
  EXPECT_EQ(limit_permille(axis, 1e9), 65535);
  EXPECT_EQ(permille_from_Nm(axis, 1.9999), 200);
  EXPECT_EQ(permille_from_Nm(axis, -1.9999), -200);
  axis.sign = -1;
  EXPECT_EQ(permille_from_Nm(axis, 1.0), -100);
  EXPECT_EQ(Nm_from_permille(axis, -100), 1.0);
}

// Each violated relation is named.
TEST(AxisUnits, CheckNamesTheField) {
  EXPECT_EQ(check(axis_of(1000.0)), "");
  const auto broken = [](auto change) {
    AxisConfig axis = axis_of(1000.0);
    change(axis);
    return check(axis);
  };
  EXPECT_NE(broken([](AxisConfig& a) { a.node_id = 0; }).find("node_id"), std::string::npos);
  EXPECT_NE(broken([](AxisConfig& a) { a.node_id = 127; }).find("node_id"), std::string::npos);
  EXPECT_NE(broken([](AxisConfig& a) { a.gear = 0; }).find("gear"), std::string::npos);
  EXPECT_NE(broken([](AxisConfig& a) { a.gear = kNan; }).find("gear"), std::string::npos);
  EXPECT_NE(broken([](AxisConfig& a) { a.sign = 0; }).find("sign"), std::string::npos);
  EXPECT_NE(broken([](AxisConfig& a) { a.min_rad = a.max_rad; }).find("min_rad"),
            std::string::npos);
  EXPECT_NE(broken([](AxisConfig& a) { a.max_rad = kNan; }).find("max_rad"), std::string::npos);
  EXPECT_NE(broken([](AxisConfig& a) { a.max_rad = 1e9; }).find("32-bit"), std::string::npos);
  EXPECT_NE(broken([](AxisConfig& a) { a.max_torque_Nm = 1e9; }).find("max_torque_Nm"),
            std::string::npos);
  EXPECT_NE(broken([](AxisConfig& a) { a.following_error_rad = 1e-9; }).find("counts"),
            std::string::npos);
}

}  // namespace
}  // namespace can
