// SPDX-License-Identifier: BSD-3-Clause
// Weight, mean and covariance of the points a node won.
#include "ddgng/moments.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/rng.h"

namespace ddgng {
namespace {

std::vector<Moment> moments_of(const Moments& moments, int slot) {
  std::vector<Moment> list;
  moments.append(slot, 17, list);
  return list;
}

// A node that won nothing has no moments.
TEST(Moments, None) {
  EXPECT_TRUE(moments_of(Moments({}, 4), 2).empty());
}

// One point: its mean is the point, its covariance zero.
TEST(Moments, OnePoint) {
  Moments moments({}, 4);
  moments.add(2, 1, {1.0F, 2.0F, 3.0F}, 0.0F);
  const auto list = moments_of(moments, 2);
  ASSERT_EQ(list.size(), 1U);
  EXPECT_EQ(list[0].node, 17);
  EXPECT_EQ(list[0].head, 1);
  EXPECT_EQ(list[0].weight, 1.0F);
  EXPECT_EQ(list[0].mean_m, Eigen::Vector3f(1.0F, 2.0F, 3.0F));
  EXPECT_EQ(list[0].xx_m2 + list[0].yy_m2 + list[0].zz_m2, 0.0F);
}

// Points at or beyond the gate and of no known head are not counted.
TEST(Moments, Gate) {
  Moments moments({}, 1);
  moments.add(0, 0, {0.0F, 0.0F, 0.0F}, 0.0601F * 0.0601F);
  moments.add(0, 0, {0.0F, 0.0F, 0.0F}, std::numeric_limits<float>::quiet_NaN());
  moments.add(0, 4, {0.0F, 0.0F, 0.0F}, 0.0F);
  EXPECT_TRUE(moments_of(moments, 0).empty());
}

// A noise of 1 mm seen 4 m away comes out right to 1 %, heads apart, off-diagonal signs kept.
TEST(Moments, AccurateFarAway) {
  Moments moments({}, 1);
  base::Rng rng(3);
  for (int i = 0; i < 40000; ++i) {
    const double g = rng.gaussian();
    const Eigen::Vector3d p(4.0 + 1e-3 * g, -4.0 - 1e-3 * g, 4.0);
    moments.add(0, i % 2 == 0 ? 0 : 3, p.cast<float>(), 1e-6F);
  }
  const auto list = moments_of(moments, 0);
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[1].head, 3);
  for (const Moment& moment : list) {
    EXPECT_EQ(moment.weight, 20000.0F);
    EXPECT_NEAR(moment.mean_m.x(), 4.0F, 3e-5F);
    EXPECT_NEAR(moment.xx_m2, 1e-6F, 3e-8F);
    EXPECT_NEAR(moment.xy_m2, -1e-6F, 3e-8F);
    EXPECT_NEAR(moment.zz_m2, 0.0F, 1e-12F);
  }
}

// Older frames count less, and what has become too light is dropped.
TEST(Moments, Forgets) {
  GrowingParams params;
  params.moment_forget = 0.5F;
  params.min_moment_weight = 0.2F;
  Moments moments(params, 1);
  moments.add(0, 0, {0.0F, 0.0F, 0.0F}, 0.0F);
  moments.forget();
  moments.add(0, 0, {3.0F, 0.0F, 0.0F}, 0.0F);
  const auto list = moments_of(moments, 0);
  ASSERT_EQ(list.size(), 1U);
  EXPECT_FLOAT_EQ(list[0].weight, 1.5F);
  EXPECT_FLOAT_EQ(list[0].mean_m.x(), 2.0F);
  for (int frame = 0; frame < 3; ++frame) moments.forget();
  EXPECT_TRUE(moments_of(moments, 0).empty());
}

// A new node in an old slot starts with nothing.
TEST(Moments, ClearedForANewNode) {
  Moments moments({}, 2);
  moments.add(0, 0, {0.0F, 0.0F, 0.0F}, 0.0F);
  moments.add(1, 0, {0.0F, 0.0F, 0.0F}, 0.0F);
  moments.clear(0);
  EXPECT_TRUE(moments_of(moments, 0).empty());
  EXPECT_FALSE(moments_of(moments, 1).empty());
}

}  // namespace
}  // namespace ddgng
