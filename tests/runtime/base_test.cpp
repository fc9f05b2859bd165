// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "base/check.h"
#include "base/quantiles.h"
#include "base/rng.h"

namespace {

// No value yet: the quantile is -1, not 0, which could be a real one.
TEST(Quantiles, EmptyIsMinusOne) {
  EXPECT_EQ(base::Quantiles{}.quantile(0.5), -1);
}

// One value is every quantile.
TEST(Quantiles, OneValue) {
  base::Quantiles quantiles;
  quantiles.add(7);
  for (const double q : {0.0, 0.5, 0.99, 1.0}) EXPECT_EQ(quantiles.quantile(q), 7);
}

// The median of 1..100 in any order is its upper middle, the maximum is 100.
TEST(Quantiles, OrderDoesNotMatter) {
  base::Quantiles quantiles;
  for (int i = 0; i < 100; ++i) quantiles.add((i * 37) % 100 + 1);
  EXPECT_EQ(quantiles.quantile(0.5), 51);
  EXPECT_EQ(quantiles.quantile(1.0), 100);
}

// Values older than the capacity are forgotten.
TEST(Quantiles, KeepsTheNewest) {
  base::Quantiles quantiles;
  quantiles.add(1'000'000);
  for (std::size_t i = 0; i < base::Quantiles::kCapacity; ++i) quantiles.add(1);
  EXPECT_EQ(quantiles.quantile(1.0), 1);
}

// The generator's numbers are pinned: a golden log made today must replay the same tomorrow, on
// every machine.
TEST(Rng, PinnedNumbers) {
  base::Rng rng(0);
  EXPECT_EQ(rng.next(), 0xE220A8397B1DCDAFULL);  // SplitMix64's published first output for seed 0
  EXPECT_EQ(rng.next(), 0x6E789E6AA1B965F4ULL);
}

// Streams of neighbouring frames do not repeat each other.
TEST(Rng, StreamsDiffer) {
  std::set<std::uint64_t> seen;
  for (std::uint64_t frame = 0; frame < 100; ++frame) {
    base::Rng rng(1, frame);
    for (int i = 0; i < 10; ++i) seen.insert(rng.next());
  }
  EXPECT_EQ(seen.size(), 1000U);
}

// below(n) hits every number below n and none other; below(1) is always 0.
TEST(Rng, BelowCoversItsRange) {
  base::Rng rng(3);
  std::set<std::uint32_t> seen;
  for (int i = 0; i < 1000; ++i) seen.insert(rng.below(7));
  EXPECT_EQ(seen.size(), 7U);
  EXPECT_EQ(*seen.rbegin(), 6U);
  EXPECT_EQ(rng.below(1), 0U);
}

// Mean 0 and standard deviation 1 within the error of 20 000 draws.
TEST(Rng, GaussianMoments) {
  base::Rng rng(5);
  double sum = 0.0, squares = 0.0;
  constexpr int kDraws = 20'000;
  for (int i = 0; i < kDraws; ++i) {
    const double value = rng.gaussian();
    sum += value;
    squares += value * value;
  }
  EXPECT_NEAR(sum / kDraws, 0.0, 0.03);
  EXPECT_NEAR(squares / kDraws, 1.0, 0.04);
}

// A broken invariant ends the process with its message, in optimised builds too.
TEST(CheckDeathTest, Aborts) {
  EXPECT_DEATH(CHECK(1 == 2, "one is not two"), "one is not two");
}

}  // namespace
