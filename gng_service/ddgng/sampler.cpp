// SPDX-License-Identifier: BSD-3-Clause
#include "ddgng/sampler.h"

#include <algorithm>

namespace ddgng {
namespace {

// Nothing that a robot sees is farther; also false for NaN, so a broken point is only ignored.
constexpr float kReach_m = 1e4F;

bool within_reach(const Eigen::Vector3f& p) {
  return p.x() >= -kReach_m && p.x() <= kReach_m && p.y() >= -kReach_m && p.y() <= kReach_m &&
         p.z() >= -kReach_m && p.z() <= kReach_m;
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
  signals_.clear();
  for (std::size_t i = 0; i < num_drawn; ++i) {
    const std::uint32_t ahead = drawn_[std::min(i + kAhead, num_drawn - 1)];
    __builtin_prefetch(&cloud.x_m[ahead]);
    __builtin_prefetch(&cloud.y_m[ahead]);
    __builtin_prefetch(&cloud.z_m[ahead]);
    __builtin_prefetch(&cloud.head[ahead]);
    const std::uint32_t index = drawn_[i];
    const Signal signal{{cloud.x_m[index], cloud.y_m[index], cloud.z_m[index]}, cloud.head[index]};
    if (within_reach(signal.position_m)) signals_.push_back(signal);
  }
  return signals_;
}

std::span<const Signal> Sampler::draw_uniform(const CloudView& cloud, int num_signals) {
  drawn_.clear();
  const auto num_points = static_cast<std::uint32_t>(cloud.size());
  if (num_points == 0) return {};
  for (int i = 0; i < num_signals; ++i) drawn_.push_back(rng_.below(num_points));
  return fetch(cloud);
}

std::span<const Signal> Sampler::draw(const CloudView& cloud,
                                      std::span<const std::uint32_t> suspected) {
  const int num_signals = num_uniform_ + num_attention_;
  if (suspected.empty()) return draw_uniform(cloud, num_signals);
  drawn_.clear();
  const auto num_points = static_cast<std::uint32_t>(cloud.size());
  const auto num_suspected = static_cast<std::uint32_t>(suspected.size());
  int owed = 0;  // uniform draws, in units of 1 / num_signals
  for (int i = 0; i < num_signals; ++i) {
    owed += num_uniform_;
    if (owed >= num_signals) {
      owed -= num_signals;
      drawn_.push_back(rng_.below(num_points));
    } else {
      drawn_.push_back(suspected[rng_.below(num_suspected)]);
    }
  }
  return fetch(cloud);
}

}  // namespace ddgng
