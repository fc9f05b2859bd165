// SPDX-License-Identifier: BSD-3-Clause
#include "ddgng/sampler.h"

#include <algorithm>
#include <cmath>

namespace ddgng {
namespace {

// Nothing that a robot sees is farther; also false for NaN, so a broken point is only ignored.
constexpr float kReach_m = 1e4F;

bool within_reach(const Eigen::Vector3f& p) {
  const auto is_within = [](float m) { return static_cast<int>(std::abs(m) <= kReach_m); };
  return (is_within(p.x()) & is_within(p.y()) & is_within(p.z())) != 0;  // one branch, not six
}

}  // namespace

Sampler::Sampler(const GrowingParams& params)
    : seed_(params.seed),
      num_uniform_(params.uniform_signals),
      num_attention_(params.attention_signals),
      rng_(params.seed) {
  const int max_signals = std::max(num_uniform_ + num_attention_, params.boot_signals);
  drawn_.reserve(max_signals);
  signals_.reserve(max_signals);
}

// Without those beyond reach. The points lie anywhere in memory, so each is asked for in time.
std::span<const Signal> Sampler::fetch(const CloudView& cloud) {
  constexpr std::size_t kAhead = 24;
  const std::size_t num_drawn = drawn_.size();
  signals_.resize(num_drawn);
  std::size_t num_signals = 0;
  for (std::size_t i = 0; i < num_drawn; ++i) {
    const std::uint32_t ahead = drawn_[std::min(i + kAhead, num_drawn - 1)];
    __builtin_prefetch(&cloud.x_m[ahead]);
    __builtin_prefetch(&cloud.y_m[ahead]);
    __builtin_prefetch(&cloud.z_m[ahead]);
    __builtin_prefetch(&cloud.head[ahead]);
    const std::uint32_t index = drawn_[i];
    Signal& signal = signals_[num_signals];
    signal = {{cloud.x_m[index], cloud.y_m[index], cloud.z_m[index]}, cloud.head[index]};
    num_signals += within_reach(signal.position_m) ? 1 : 0;
  }
  signals_.resize(num_signals);
  return signals_;
}

std::span<const Signal> Sampler::draw_uniform(const CloudView& cloud, int num_signals) {
  const auto num_points = static_cast<std::uint32_t>(cloud.size());
  if (num_points == 0) return {};
  drawn_.resize(num_signals);
  for (std::uint32_t& index : drawn_) index = rng_.below(num_points);
  return fetch(cloud);
}

std::span<const Signal> Sampler::draw(const CloudView& cloud,
                                      std::span<const std::uint32_t> suspected) {
  const int num_signals = num_uniform_ + num_attention_;
  if (suspected.empty()) return draw_uniform(cloud, num_signals);
  const auto num_points = static_cast<std::uint32_t>(cloud.size());
  const auto num_suspected = static_cast<std::uint32_t>(suspected.size());
  base::Rng rng = rng_;  // a copy that nothing else can reach is kept in registers
  drawn_.resize(num_signals);
  int owed = 0;  // uniform draws, in units of 1 / num_signals
  for (std::uint32_t& index : drawn_) {
    owed += num_uniform_;
    if (owed >= num_signals) {
      owed -= num_signals;
      index = rng.below(num_points);
    } else {
      index = suspected[rng.below(num_suspected)];
    }
  }
  rng_ = rng;
  return fetch(cloud);
}

}  // namespace ddgng
