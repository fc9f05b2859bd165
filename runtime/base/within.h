// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace base {

/// Bounds included; false for NaN.
constexpr bool within(double value, double low, double high) {
  return value >= low && value <= high;
}

}  // namespace base
