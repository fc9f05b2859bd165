// SPDX-License-Identifier: BSD-3-Clause
// The newest values of a quantity by their time of measurement, in a ring: for any time the two
// values round it. Says when there is none near enough.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/check.h"
#include "tof/params.h"

namespace tof {

template <class T>
class TimeHistory {
 public:
  /// fraction 0 = a, 1 = b; above 1 when extrapolated.
  struct Bracket {
    const T* a = nullptr;
    const T* b = nullptr;
    double fraction = 0.0;
  };

  explicit TimeHistory(const PoseParams& params)
      : entries_(static_cast<std::size_t>(params.capacity)),
        max_gap_us_(to_us(params.max_gap_s)),
        max_extrapolation_us_(to_us(params.max_extrapolation_s)) {}

  /// False, and nothing changes, unless this is newer than all before.
  bool push(std::int64_t utime_us, const T& value) {
    if (size_ > 0 && utime_us <= newest().utime_us) return false;
    first_ = size_ == entries_.size() ? (first_ + 1) % entries_.size() : first_;
    size_ = size_ == entries_.size() ? size_ : size_ + 1;
    entries_[(first_ + size_ - 1) % entries_.size()] = {utime_us, value};
    return true;
  }

  void clear() { first_ = size_ = 0; }
  std::size_t size() const { return size_; }
  const T& newest_value() const {
    CHECK(size_ > 0, "an empty history has no newest value");
    return newest().value;
  }

  /// None when empty, in a gap longer than max_gap, or farther than max_extrapolation from the
  /// ends. Before the oldest value that one holds; after the newest the line through it and one at
  /// least max_extrapolation older goes on, so that noise grows by no more than the factor 3.
  std::optional<Bracket> at(std::int64_t utime_us) const {
    if (size_ == 0) return std::nullopt;
    if (utime_us <= at_rank(0).utime_us) {
      if (at_rank(0).utime_us - utime_us > max_extrapolation_us_) return std::nullopt;
      return Bracket{&at_rank(0).value, &at_rank(0).value, 0.0};
    }
    if (utime_us > newest().utime_us) return beyond_newest(utime_us);
    const std::size_t after = first_not_before(utime_us);
    const Entry& a = at_rank(after - 1);
    const Entry& b = at_rank(after);
    if (b.utime_us == utime_us) return Bracket{&b.value, &b.value, 0.0};
    if (b.utime_us - a.utime_us > max_gap_us_) return std::nullopt;
    return Bracket{&a.value, &b.value, ratio(utime_us - a.utime_us, b.utime_us - a.utime_us)};
  }

 private:
  struct Entry {
    std::int64_t utime_us = 0;
    T value{};
  };

  static std::int64_t to_us(double seconds) { return static_cast<std::int64_t>(seconds * 1e6); }
  static double ratio(std::int64_t part, std::int64_t whole) {
    return static_cast<double>(part) / static_cast<double>(whole);
  }
  const Entry& at_rank(std::size_t rank) const {
    return entries_[(first_ + rank) % entries_.size()];
  }
  const Entry& newest() const { return at_rank(size_ - 1); }

  /// Rank of the first entry with utime >= utime_us; there is one.
  std::size_t first_not_before(std::int64_t utime_us) const {
    std::size_t low = 0;
    std::size_t high = size_ - 1;
    while (low < high) {
      const std::size_t middle = (low + high) / 2;
      if (at_rank(middle).utime_us < utime_us) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    return low;
  }

  std::optional<Bracket> beyond_newest(std::int64_t utime_us) const {
    const Entry& b = newest();
    if (utime_us - b.utime_us > max_extrapolation_us_) return std::nullopt;
    for (std::size_t rank = size_ - 1; rank-- > 0;) {
      const Entry& a = at_rank(rank);
      const std::int64_t baseline_us = b.utime_us - a.utime_us;
      if (baseline_us > max_gap_us_ + max_extrapolation_us_) break;
      if (baseline_us < max_extrapolation_us_) continue;
      return Bracket{&a.value, &b.value, ratio(utime_us - a.utime_us, baseline_us)};
    }
    return Bracket{&b.value, &b.value, 0.0};
  }

  std::vector<Entry> entries_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
  std::int64_t max_gap_us_;
  std::int64_t max_extrapolation_us_;
};

}  // namespace tof
