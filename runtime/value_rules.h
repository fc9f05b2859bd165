// SPDX-License-Identifier: BSD-3-Clause
// The rules that runtime/semantic_checks.cpp is written in. Each is false for NaN and infinities,
// and true for an empty span.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace runtime::rules {

inline constexpr double kPositionLimit_m = 1e4;  ///< |coordinate|; farther is a mistake
inline constexpr double kUnitTolerance = 1e-3;   ///< of the length of quaternions and normals

template <class T>
bool within(T value, double low, double high) {
  return static_cast<double>(value) >= low && static_cast<double>(value) <= high;
}

template <class Values>
bool all_within(const Values& values, double low, double high) {
  return std::all_of(std::begin(values), std::end(values),
                     [=](auto value) { return within(value, low, high); });
}

template <class Values>
bool all_finite(const Values& values) {
  return std::all_of(std::begin(values), std::end(values),
                     [](auto value) { return std::isfinite(value); });
}

template <class Values>
bool all_at_least(const Values& values, double low) {
  return std::all_of(std::begin(values), std::end(values), [=](auto value) {
    return std::isfinite(static_cast<double>(value)) && static_cast<double>(value) >= low;
  });
}

template <class Values>
bool are_positions(const Values& values) {
  return all_within(values, -kPositionLimit_m, kPositionLimit_m);
}

template <class Values, class... More>
bool are_positions(const Values& values, const More&... more) {
  return are_positions(values) && are_positions(more...);
}

/// Length 1 within kUnitTolerance.
template <class Values>
bool is_unit(const Values& values) {
  double sum = 0.0;
  for (const auto value : values) sum += static_cast<double>(value) * static_cast<double>(value);
  return within(std::sqrt(sum), 1.0 - kUnitTolerance, 1.0 + kUnitTolerance);
}

/// Each (x[i], y[i], z[i]) has length 1 within kUnitTolerance; same sizes.
template <class Values>
bool are_unit(const Values& x, const Values& y, const Values& z) {
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double vector[3] = {x[i], y[i], z[i]};
    if (!is_unit(vector)) return false;
  }
  return true;
}

/// Every value in first .. count - 1: first 0 for an index, -1 where -1 stands for none.
template <class Values>
bool are_indices(const Values& values, int count, int first = 0) {
  return all_within(values, first, count - 1);
}

/// a[i] < b[i]; same sizes.
template <class Values>
bool each_less(const Values& a, const Values& b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!(a[i] < b[i])) return false;
  }
  return true;
}

template <class Values>
bool strictly_ascending(const Values& values) {
  return std::adjacent_find(std::begin(values), std::end(values),
                            [](auto a, auto b) { return !(a < b); }) == std::end(values);
}

/// Pairs (a[i], b[i]) in ascending lexical order, none twice; same sizes.
template <class First, class Second>
bool pairs_ascending(const First& a, const Second& b) {
  for (std::size_t i = 1; i < a.size(); ++i) {
    if (a[i] < a[i - 1] || (a[i] == a[i - 1] && !(b[i - 1] < b[i]))) return false;
  }
  return true;
}

/// Finite, and no negative variance on the diagonal; six spans of the same size.
template <class Values>
bool are_covariances(const Values& xx, const Values& xy, const Values& xz, const Values& yy,
                     const Values& yz, const Values& zz) {
  return all_at_least(xx, 0.0) && all_at_least(yy, 0.0) && all_at_least(zz, 0.0) &&
         all_finite(xy) && all_finite(xz) && all_finite(yz);
}

}  // namespace runtime::rules
