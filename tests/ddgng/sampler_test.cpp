// SPDX-License-Identifier: BSD-3-Clause
// Which points become signals.
#include "ddgng/sampler.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace ddgng {
namespace {

struct Points {
  explicit Points(int num) {
    for (int i = 0; i < num; ++i) {
      x_m.push_back(static_cast<float>(i));
      head.push_back(static_cast<std::uint8_t>(i % 4));
    }
  }
  CloudView view() const {
    CloudView cloud;
    cloud.x_m = cloud.y_m = cloud.z_m = x_m;
    cloud.head = head;
    return cloud;
  }
  std::vector<float> x_m;
  std::vector<std::uint8_t> head;
};

Sampler started(int uniform, int attention, std::uint64_t sequence = 0) {
  GrowingParams params;
  params.uniform_signals = uniform;
  params.attention_signals = attention;
  Sampler sampler(params);
  sampler.start_frame(sequence);
  return sampler;
}

// An empty cloud gives no signals.
TEST(Sampler, EmptyCloud) {
  Sampler sampler = started(10, 10);
  EXPECT_TRUE(sampler.draw(Points(0).view(), {}).empty());
  EXPECT_TRUE(sampler.draw_uniform(Points(0).view(), 5).empty());
}

// A single point is every signal, and a signal carries its head.
TEST(Sampler, OnePoint) {
  Sampler sampler = started(3, 4);
  Points one(1);
  one.head[0] = 3;
  const auto signals = sampler.draw(one.view(), {});
  ASSERT_EQ(signals.size(), 7U);
  for (const Signal& signal : signals) EXPECT_EQ(signal.head, 3);
}

// Points that are not finite or beyond all reach are no signals.
TEST(Sampler, IgnoresBrokenPoints) {
  Sampler sampler = started(50, 0);
  Points points(3);
  points.x_m = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                -1e30F};
  EXPECT_TRUE(sampler.draw(points.view(), {}).empty());
}

// Uniform and attention signals come in the asked numbers, evenly interleaved.
TEST(Sampler, InterleavesEvenly) {
  Sampler sampler = started(100, 400);
  const Points points(1000);
  const std::vector<std::uint32_t> suspected{5, 6, 7};
  const auto signals = sampler.draw(points.view(), suspected);
  ASSERT_EQ(signals.size(), 500U);
  for (std::size_t i = 0; i < signals.size(); ++i) {
    const float x = signals[i].position_m.x();
    EXPECT_TRUE(i % 5 == 4 || (x >= 5.0F && x <= 7.0F)) << i;
  }
}

// With 250 and 250 signals every second one is from the suspected area (Alg. 1, line 5).
TEST(Sampler, PaperTakesEverySecond) {
  const GrowingParams params = paper_params();
  Sampler sampler = started(params.uniform_signals, params.attention_signals);
  const Points points(10000);
  const std::vector<std::uint32_t> suspected{9999};
  const auto signals = sampler.draw(points.view(), suspected);
  int num_suspected = 0;
  for (std::size_t i = 0; i < signals.size(); i += 2) {
    num_suspected += signals[i].position_m.x() == 9999.0F ? 1 : 0;
  }
  EXPECT_EQ(num_suspected, 250);
}

// Nothing suspected: as many signals, all from the whole cloud.
TEST(Sampler, WithoutSuspicionAllUniform) {
  Sampler sampler = started(100, 400);
  Points points(4);
  std::vector<int> hits(4);
  for (const Signal& signal : sampler.draw(points.view(), {})) {
    ++hits[static_cast<std::size_t>(std::lround(signal.position_m.x()))];
  }
  for (const int num : hits) EXPECT_NEAR(num, 125, 50);
}

// The draws of a frame depend on its sequence number, not on what was drawn before.
TEST(Sampler, FramesAreIndependent) {
  const Points points(1000);
  Sampler fresh = started(100, 0, 7);
  Sampler used = started(100, 0, 6);
  used.draw(points.view(), {});
  used.start_frame(7);
  const auto expected = fresh.draw(points.view(), {});
  const auto found = used.draw(points.view(), {});
  ASSERT_EQ(expected.size(), found.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(expected[i].position_m, found[i].position_m);
  }
}

}  // namespace
}  // namespace ddgng
