// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

namespace climb {

/// Whether a direction or a quaternion has length one as far as a sound sender rounds; false for
/// NaN.
template <typename V>
bool is_unit(const V& v) {
  constexpr double kMaxError = 1e-3;
  return std::abs(v.norm() - 1.0) <= kMaxError;
}

}  // namespace climb
