// SPDX-License-Identifier: BSD-3-Clause
// Seeded random numbers with the same bits on every machine (the standard's distributions do not
// promise that).
#pragma once

#include <cstdint>

namespace base {

/// SplitMix64 (Steele, Lea, Flood 2014): 64-bit state, passes BigCrush, one multiply chain per
/// number.
class Rng {
 public:
  explicit Rng(std::uint64_t seed) : state_(seed) {}

  /// An independent stream for each (seed, sequence number): the generator is re-made per frame.
  Rng(std::uint64_t seed, std::uint64_t sequence) : state_(seed) {
    state_ = next() ^ (sequence * 0xD1B54A32D192ED03ULL);
  }

  /// Uniform in [0, 2^64).
  std::uint64_t next() {
    state_ += 0x9E3779B97F4A7C15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31);
  }

  /// Uniform in [0, bound), bound >= 1; bias below bound / 2^32 (Lemire's multiply-shift).
  std::uint32_t below(std::uint32_t bound) {
    return static_cast<std::uint32_t>(((next() >> 32) * bound) >> 32);
  }

  /// Uniform in [0, 1), 53 bits.
  double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }

  /// Mean 0, standard deviation 1, within +-6: sum of twelve uniforms, so only additions are used.
  double gaussian() {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += uniform();
    return sum;
  }

 private:
  std::uint64_t state_;
};

}  // namespace base
