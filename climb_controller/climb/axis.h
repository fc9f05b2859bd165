// SPDX-License-Identifier: BSD-3-Clause
// The sixteen drives: three joints and the jaw of each leg, numbered as on the bus (4 leg + joint).
#pragma once

#include <array>
#include <cmath>

#include "climb/leg.h"

namespace climb {

inline constexpr int kNumAxesPerLeg = kNumLegJoints + 1;
inline constexpr int kJaw = kNumLegJoints;  ///< joint number of a leg's jaw
inline constexpr int kNumAxes = kNumLegs * kNumAxesPerLeg;

template <typename T>
using PerAxis = std::array<T, kNumAxes>;

constexpr int axis_of(Leg leg, int joint) {
  return kNumAxesPerLeg * leg + joint;
}

}  // namespace climb
