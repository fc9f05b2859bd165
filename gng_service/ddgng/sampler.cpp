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
  signals_.reserve(std::max(num_uniform_ + num_attention_, params.boot_signals));
}

void Sampler::push(const CloudView& cloud, std::uint32_t index) {
  const Signal signal{{cloud.x_m[index], cloud.y_m[index], cloud.z_m[index]}, cloud.head[index]};
  if (within_reach(signal.position_m)) signals_.push_back(signal);
}

std::span<const Signal> Sampler::draw_uniform(const CloudView& cloud, int num_signals) {
  signals_.clear();
  const auto num_points = static_cast<std::uint32_t>(cloud.size());
  if (num_points == 0) return {};
  for (int i = 0; i < num_signals; ++i) push(cloud, rng_.below(num_points));
  return signals_;
}

std::span<const Signal> Sampler::draw(const CloudView& cloud,
                                      std::span<const std::uint32_t> suspected) {
  const int num_signals = num_uniform_ + num_attention_;
  if (suspected.empty()) return draw_uniform(cloud, num_signals);
  signals_.clear();
  const auto num_points = static_cast<std::uint32_t>(cloud.size());
  const auto num_suspected = static_cast<std::uint32_t>(suspected.size());
  int owed = 0;  // uniform draws, in units of 1 / num_signals
  for (int i = 0; i < num_signals; ++i) {
    owed += num_uniform_;
    if (owed >= num_signals) {
      owed -= num_signals;
      push(cloud, rng_.below(num_points));
    } else {
      push(cloud, suspected[rng_.below(num_suspected)]);
    }
  }
  return signals_;
}

}  // namespace ddgng
