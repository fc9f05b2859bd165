// SPDX-License-Identifier: BSD-3-Clause
// Algorithm 1, the draws: which points become signals, from all points or from the suspected area.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "base/rng.h"
#include "ddgng/cloud.h"
#include "ddgng/params.h"

namespace ddgng {

struct Signal {
  Eigen::Vector3f position_m;
  int head = 0;
};

class Sampler {
 public:
  explicit Sampler(const GrowingParams& params);

  /// The random numbers of the frame depend on (seed, sequence) alone.
  void start_frame(std::uint64_t sequence) { rng_ = base::Rng(seed_, sequence); }

  /// num_signals points, each drawn from all of the cloud. Empty for an empty cloud.
  std::span<const Signal> draw_uniform(const CloudView& cloud, int num_signals);

  /// The frame's signals, uniform and attention evenly interleaved (Alg. 1, lines 4-8). suspected:
  /// indices into the cloud; when it is empty, all draws are uniform. Empty for an empty cloud.
  std::span<const Signal> draw(const CloudView& cloud, std::span<const std::uint32_t> suspected);

 private:
  std::span<const Signal> fetch(const CloudView& cloud);

  std::uint64_t seed_;
  int num_uniform_;
  int num_attention_;
  base::Rng rng_;
  std::vector<std::uint32_t> drawn_;  // indices into the cloud
  std::vector<Signal> signals_;
};

}  // namespace ddgng
