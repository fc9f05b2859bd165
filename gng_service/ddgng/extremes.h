// SPDX-License-Identifier: BSD-3-Clause
// The node of the largest error and the one of the least utility. A signal changes few nodes, so
// the extremes of blocks of 16 slots are kept and only touched blocks are looked at again.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace ddgng {

/// Arrays over slots, padded to whole blocks. An empty slot has error kNoError and utility
/// kNoUtility.
struct SlotValues {
  const float* error;
  const float* utility;
  const std::uint8_t* inside;  ///< 1 = in the suspected area
};

/// Of the slots outside and inside the suspected area.
struct BlockExtremes {
  float error[2];
  float negative_utility[2];
};

class Extremes {
 public:
  static constexpr int kBlock = 16;
  static constexpr float kNoError = -1.0F;
  static constexpr float kNoUtility = 3e38F;

  explicit Extremes(int num_slots);

  /// A value of this slot has changed. Every change must be told.
  void touch(int slot) {
    bounds_hold_ = false;
    mark(slot);
  }
  /// The same when both values have risen.
  void touch_risen(int slot, float error) {
    error_bound_ = std::max(error_bound_, error);
    mark(slot);
  }
  void touch_all();

  /// No error is above it and no utility below them (outside, inside): where these say that nothing
  /// is useless, nobody need look for the extremes. Found anew by find_bounds().
  struct Bounds {
    float error;
    float utility[2];
  };
  bool bounds_hold() const { return bounds_hold_; }
  Bounds bounds() const { return {error_bound_, {utility_bound_[0], utility_bound_[1]}}; }
  void find_bounds(const SlotValues& values);

  struct Found {
    int slot = -1;
    float value = 0.0F;
  };
  /// The largest error, those inside times a weight; of equals the lowest slot. value <= kNoError
  /// times the weight: no node.
  Found largest_error(const SlotValues& values, float inside_weight);
  /// The least utility, those inside times a scale; of equals the lowest slot.
  Found least_utility(const SlotValues& values, float inside_scale);

 private:
  void mark(int slot) {
    const int block = static_cast<int>(static_cast<unsigned>(slot) / kBlock);
    if (is_touched_[block] != 0) return;
    is_touched_[block] = 1;
    touched_.push_back(block);
  }
  void refresh(const SlotValues& values);

  int num_blocks_;
  // Over blocks, padded to a multiple of kBlock: largest error outside and inside, largest negative
  // utility outside and inside.
  std::vector<float> error_[2], negative_utility_[2];
  std::vector<std::uint8_t> is_touched_;
  std::vector<int> touched_;
  bool bounds_hold_ = false;
  float error_bound_ = 0.0F;
  float utility_bound_[2] = {0.0F, 0.0F};
};

}  // namespace ddgng
