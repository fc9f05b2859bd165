// SPDX-License-Identifier: BSD-3-Clause
// Statistics of the sensor model against the numbers it promises.
#include "simulator/sensor_model.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace simulator {
namespace {

using ::testing::HasSubstr;

constexpr int kNumSamples = 40000;

struct Statistics {
  double mean_m = 0.0, sigma_m = 0.0, dropped = 0.0;
};

Statistics measure(const SensorParams& params, const Return& light, bool on_edge) {
  const SensorModel model(params);
  base::Rng rng(11);
  double sum = 0.0, square_sum = 0.0;
  int num_returns = 0;
  for (int i = 0; i < kNumSamples; ++i) {
    const double range_m = static_cast<double>(model.measure(light, on_edge, rng));
    if (range_m <= 0.0) continue;
    ++num_returns;
    sum += range_m;
    square_sum += range_m * range_m;
  }
  const double mean = sum / num_returns;
  return {mean, std::sqrt(square_sum / num_returns - mean * mean),
          1.0 - static_cast<double>(num_returns) / kNumSamples};
}

SensorParams without_wiggle() {
  SensorParams params;
  params.wiggle_m = 0.0;
  return params;
}

// On mid-grey the noise is 1 % of the range without bias; below 0.2 m it is the floor of 2 mm.
TEST(SensorModel, NoiseIsOnePercent) {
  for (const float range_m : {0.15F, 0.6F, 1.5F, 3.0F}) {
    const Statistics found = measure(without_wiggle(), {range_m, 0.5F}, false);
    const double expected = std::max(0.002, 0.01 * static_cast<double>(range_m));
    EXPECT_NEAR(found.sigma_m, expected, 0.03 * expected) << range_m;
    EXPECT_NEAR(found.mean_m, static_cast<double>(range_m), 0.03 * expected) << range_m;
  }
}

// A fifth of the light means sqrt(5) of the noise; with next to none it stays bounded.
TEST(SensorModel, LessLightMoreNoise) {
  const double grey = measure(without_wiggle(), {1.0F, 0.5F}, false).sigma_m;
  const double dark = measure(without_wiggle(), {1.0F, 0.1F}, false).sigma_m;
  const double black = measure(without_wiggle(), {1.0F, 1e-6F}, false).sigma_m;
  EXPECT_NEAR(dark / grey, std::sqrt(5.0), 0.1);
  EXPECT_NEAR(black / grey, 4.0, 0.2);
}

// 3 % of all pixels and 40 % of the rest on an edge return nothing.
TEST(SensorModel, Dropouts) {
  EXPECT_NEAR(measure({}, {1.0F, 0.5F}, false).dropped, 0.03, 0.005);
  EXPECT_NEAR(measure({}, {1.0F, 0.5F}, true).dropped, 1.0 - 0.97 * 0.6, 0.01);
}

// No light, or a target beyond or before the range: nothing.
TEST(SensorModel, OutOfRangeIsNothing) {
  EXPECT_EQ(measure({}, {1.0F, 0.0F}, false).dropped, 1.0);
  EXPECT_EQ(measure({}, {4.01F, 0.5F}, false).dropped, 1.0);
  EXPECT_EQ(measure({}, {0.05F, 0.5F}, false).dropped, 1.0);
  EXPECT_EQ(measure({}, {std::numeric_limits<float>::infinity(), 0.5F}, false).dropped, 1.0);
}

// Beyond the wrap range a wall at 3.2 m appears at 0.71 m.
TEST(SensorModel, Wraps) {
  SensorParams params = without_wiggle();
  params.wrap_range_m = 2.49;
  EXPECT_NEAR(measure(params, {3.2F, 0.5F}, false).mean_m, 0.71, 0.002);
}

// The wiggle stays within its amplitude, reaches it, and has no mean over its period.
TEST(SensorModel, WiggleIsBounded) {
  const SensorModel model(SensorParams{});
  float least = 0.0F, most = 0.0F;
  double sum = 0.0;
  constexpr int kSteps = 10000;
  for (int i = 0; i < kSteps; ++i) {
    const float wiggle = model.wiggle_m(2.49F * static_cast<float>(i) / kSteps);
    least = std::min(least, wiggle);
    most = std::max(most, wiggle);
    sum += static_cast<double>(wiggle);
  }
  EXPECT_NEAR(most, 0.003F, 1e-5F);
  EXPECT_NEAR(least, -0.003F, 1e-5F);
  EXPECT_NEAR(sum / kSteps, 0.0, 1e-5);
}

// Confidence falls with range and rises with light; no light is worthless.
TEST(SensorModel, ConfidenceFollowsTheLight) {
  EXPECT_GT(SensorModel::confidence({1.0F, 0.5F}), SensorModel::confidence({2.0F, 0.5F}));
  EXPECT_GT(SensorModel::confidence({1.0F, 0.5F}), SensorModel::confidence({1.0F, 0.1F}));
  EXPECT_EQ(SensorModel::confidence({1.0F, 0.0F}), 0);
}

// Refused parameters are named; NaN is refused.
TEST(SensorParams, CheckNamesTheField) {
  EXPECT_EQ(check(SensorParams{}), "");
  SensorParams params;
  params.width_px = 0;
  EXPECT_THAT(check(params), HasSubstr("width_px"));
  params = {};
  params.range_min_m = 5.0;
  EXPECT_THAT(check(params), HasSubstr("range_min_m"));
  params = {};
  params.noise_share = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(check(params), HasSubstr("noise_share"));
}

}  // namespace
}  // namespace simulator
