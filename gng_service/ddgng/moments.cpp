// SPDX-License-Identifier: BSD-3-Clause
#include "ddgng/moments.h"

#include <algorithm>

namespace ddgng {

Moments::Moments(const GrowingParams& params, int num_slots)
    : gate_m2_(params.moment_gate_m * params.moment_gate_m),
      forget_(params.moment_forget),
      min_weight_(params.min_moment_weight),
      sums_(index(num_slots, 0) + 1) {}

void Moments::clear() {
  std::fill(sums_.begin(), sums_.end(), Sums{});
}

void Moments::clear(int slot) {
  std::fill_n(&sums_[index(slot, 0)], kNumHeads, Sums{});
}

void Moments::forget() {
  for (Sums& sums : sums_) {
    if (sums.weight == 0.0) continue;
    for (double* value : {&sums.weight, &sums.x_m, &sums.y_m, &sums.z_m, &sums.xx_m2, &sums.xy_m2,
                          &sums.xz_m2, &sums.yy_m2, &sums.yz_m2, &sums.zz_m2}) {
      *value *= forget_;
    }
    if (sums.weight < min_weight_) sums = {};
  }
}

void Moments::add(int slot, int head, const Eigen::Vector3f& point_m, float distance_m2) {
  if (head < 0 || head >= kNumHeads) return;
  const double x = point_m.x();
  const double y = point_m.y();
  const double z = point_m.z();
  // Nobody could predict whether a point counts: rather than branch, sum the others up elsewhere.
  Sums& sums = sums_[distance_m2 < gate_m2_ ? index(slot, head) : sums_.size() - 1];
  sums.weight += 1.0;
  sums.x_m += x;
  sums.y_m += y;
  sums.z_m += z;
  sums.xx_m2 += x * x;
  sums.xy_m2 += x * y;
  sums.xz_m2 += x * z;
  sums.yy_m2 += y * y;
  sums.yz_m2 += y * z;
  sums.zz_m2 += z * z;
}

void Moments::add(std::span<const Signal> signals, const Winners* winners) {
  for (std::size_t i = 0; i < signals.size(); ++i) {  // all asked for before the first is needed
    const Sums& sums = sums_[index(winners[i].first, signals[i].head & (kNumHeads - 1))];
    __builtin_prefetch(&sums);
    __builtin_prefetch(&sums.zz_m2);
  }
  for (std::size_t i = 0; i < signals.size(); ++i) {
    const Signal& signal = signals[i];
    add(winners[i].first, signal.head, signal.position_m, winners[i].first_m2);
  }
}

void Moments::append(int slot, int node, std::vector<Moment>& moments) const {
  for (int head = 0; head < kNumHeads; ++head) {
    const Sums& sums = sums_[index(slot, head)];
    if (sums.weight == 0.0) continue;
    const double x = sums.x_m / sums.weight;
    const double y = sums.y_m / sums.weight;
    const double z = sums.z_m / sums.weight;
    Moment moment;
    moment.node = node;
    moment.head = head;
    moment.weight = static_cast<float>(sums.weight);
    moment.mean_m = {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
    // Rounding may leave a variance of -1e-16.
    moment.xx_m2 = static_cast<float>(std::max(0.0, sums.xx_m2 / sums.weight - x * x));
    moment.xy_m2 = static_cast<float>(sums.xy_m2 / sums.weight - x * y);
    moment.xz_m2 = static_cast<float>(sums.xz_m2 / sums.weight - x * z);
    moment.yy_m2 = static_cast<float>(std::max(0.0, sums.yy_m2 / sums.weight - y * y));
    moment.yz_m2 = static_cast<float>(sums.yz_m2 / sums.weight - y * z);
    moment.zz_m2 = static_cast<float>(std::max(0.0, sums.zz_m2 / sums.weight - z * z));
    moments.push_back(moment);
  }
}

}  // namespace ddgng
