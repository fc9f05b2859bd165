// SPDX-License-Identifier: BSD-3-Clause
// Compiled once per instruction set by Highway; the best one of the machine is chosen at run time.
#include "ddgng/extremes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ddgng/extremes.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace ddgng {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

BlockExtremes OfBlock(const SlotValues& values, int begin) {
  const hn::CappedTag<float, Extremes::kBlock> d;
  const hn::Rebind<std::uint8_t, decltype(d)> bytes;
  const hn::RebindToSigned<decltype(d)> di;
  const int num_lanes = static_cast<int>(hn::Lanes(d));
  const auto no_error = hn::Set(d, -Extremes::kNoUtility);
  const auto no_utility = no_error;
  auto error_outside = no_error;
  auto error_inside = no_error;
  auto utility_outside = no_utility;
  auto utility_inside = no_utility;
  for (int i = begin; i < begin + Extremes::kBlock; i += num_lanes) {
    const auto flags = hn::PromoteTo(di, hn::LoadU(bytes, values.inside + i));
    const auto inside = hn::RebindMask(d, hn::Ne(flags, hn::Zero(di)));
    const auto error = hn::LoadU(d, values.error + i);
    const auto utility = hn::Neg(hn::LoadU(d, values.utility + i));
    error_outside = hn::Max(error_outside, hn::IfThenElse(inside, no_error, error));
    error_inside = hn::Max(error_inside, hn::IfThenElse(inside, error, no_error));
    utility_outside = hn::Max(utility_outside, hn::IfThenElse(inside, no_utility, utility));
    utility_inside = hn::Max(utility_inside, hn::IfThenElse(inside, utility, no_utility));
  }
  const auto largest = [&d](auto v) { return hn::GetLane(hn::MaxOfLanes(d, v)); };
  return {{largest(error_outside), largest(error_inside)},
          {largest(utility_outside), largest(utility_inside)}};
}

// The largest of outside[i] and inside[i] * scale.
float LargestOf(const float* outside, const float* inside, float scale, int num) {
  const hn::CappedTag<float, Extremes::kBlock> d;
  auto largest = hn::Set(d, -Extremes::kNoUtility);
  const auto factor = hn::Set(d, scale);
  for (int i = 0; i < num; i += static_cast<int>(hn::Lanes(d))) {
    largest = hn::Max(
        largest, hn::Max(hn::LoadU(d, outside + i), hn::Mul(hn::LoadU(d, inside + i), factor)));
  }
  return hn::GetLane(hn::MaxOfLanes(d, largest));
}

}  // namespace HWY_NAMESPACE
}  // namespace ddgng
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace ddgng {

HWY_EXPORT(OfBlock);
HWY_EXPORT(LargestOf);

Extremes::Extremes(int num_slots) : num_blocks_((num_slots + kBlock - 1) / kBlock) {
  const int padded = (num_blocks_ + kBlock - 1) / kBlock * kBlock;
  for (auto* values : {&error_[0], &error_[1], &negative_utility_[0], &negative_utility_[1]}) {
    values->assign(padded, -kNoUtility);
  }
  is_touched_.resize(num_blocks_);
  touched_.reserve(num_blocks_);
  touch_all();
}

void Extremes::touch_all() {
  for (int block = 0; block < num_blocks_; ++block) touch(block * kBlock);
}

void Extremes::refresh(const SlotValues& values) {
  for (const int block : touched_) {
    const BlockExtremes found = HWY_DYNAMIC_DISPATCH(OfBlock)(values, block * kBlock);
    for (int area = 0; area < 2; ++area) {
      error_[area][block] = found.error[area];
      negative_utility_[area][block] = found.negative_utility[area];
    }
    is_touched_[block] = 0;
  }
  touched_.clear();
}

void Extremes::find_bounds(const SlotValues& values) {
  refresh(values);
  const auto largest = [this](const std::vector<float>& of_blocks) {
    return HWY_DYNAMIC_DISPATCH(LargestOf)(of_blocks.data(), of_blocks.data(), 1.0F, num_blocks_);
  };
  error_bound_ = std::max(largest(error_[0]), largest(error_[1]));
  for (int area = 0; area < 2; ++area) utility_bound_[area] = -largest(negative_utility_[area]);
  bounds_hold_ = true;
}

// Rounding keeps order, so the largest product of a block is the product of its largest value, and
// the slot is found again by equality.
Extremes::Found Extremes::largest_error(const SlotValues& values, float inside_weight) {
  refresh(values);
  const float value = HWY_DYNAMIC_DISPATCH(LargestOf)(error_[0].data(), error_[1].data(),
                                                      inside_weight, num_blocks_);
  for (int block = 0; block < num_blocks_; ++block) {
    if (error_[0][block] < value && error_[1][block] * inside_weight < value) continue;
    for (int i = block * kBlock; i < (block + 1) * kBlock; ++i) {
      const float weight = values.inside[i] != 0 ? inside_weight : 1.0F;
      if (values.error[i] * weight == value) return {i, value};
    }
  }
  return {};
}

Extremes::Found Extremes::least_utility(const SlotValues& values, float inside_scale) {
  refresh(values);
  const float negative = HWY_DYNAMIC_DISPATCH(LargestOf)(
      negative_utility_[0].data(), negative_utility_[1].data(), inside_scale, num_blocks_);
  for (int block = 0; block < num_blocks_; ++block) {
    if (negative_utility_[0][block] < negative &&
        negative_utility_[1][block] * inside_scale < negative) {
      continue;
    }
    for (int i = block * kBlock; i < (block + 1) * kBlock; ++i) {
      const float scale = values.inside[i] != 0 ? inside_scale : 1.0F;
      if (-values.utility[i] * scale == negative) return {i, -negative};
    }
  }
  return {};
}

}  // namespace ddgng
#endif
