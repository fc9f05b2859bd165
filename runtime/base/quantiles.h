// SPDX-License-Identifier: BSD-3-Clause
// Quantiles over the last few hundred values, without allocation.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace base {

/// Keeps the newest kCapacity values.
class Quantiles {
 public:
  static constexpr std::size_t kCapacity = 256;

  void add(std::int64_t value) {
    values_[next_] = value;
    next_ = (next_ + 1) % kCapacity;
    size_ = std::min(size_ + 1, kCapacity);
  }
  void clear() { size_ = next_ = 0; }
  std::size_t size() const { return size_; }

  /// The smallest kept value that at least q (0..1) of them do not exceed; -1 when empty.
  /// O(kCapacity).
  std::int64_t quantile(double q) const {
    if (size_ == 0) return -1;
    std::array<std::int64_t, kCapacity> sorted = values_;
    const auto rank = std::min(static_cast<std::size_t>(q * static_cast<double>(size_)), size_ - 1);
    std::nth_element(sorted.begin(), sorted.begin() + rank, sorted.begin() + size_);
    return sorted[rank];
  }

 private:
  std::array<std::int64_t, kCapacity> values_{};
  std::size_t next_ = 0;
  std::size_t size_ = 0;
};

}  // namespace base
