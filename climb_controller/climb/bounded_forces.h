// SPDX-License-Identifier: BSD-3-Clause
// Least contact forces that balance a wrench: without bounds in closed form, within bounds by the
// alternating direction method of multipliers (Boyd et al. 2011, sec. 5.1). Fixed sizes, no memory.
#pragma once

#include <Eigen/Core>

#include "climb/leg.h"

namespace climb {

using Forces = Eigen::Matrix<double, 3 * kNumLegs, 1>;   ///< of all feet, leg by leg
using Wrench = Eigen::Matrix<double, 6, 1>;              ///< force, and moment as a force
using Balance = Eigen::Matrix<double, 6, 3 * kNumLegs>;  ///< wrench = balance * forces

/// argmin sum f^2 / weight2 with balance * f = wanted; where no forces balance, those that come
/// nearest. weight2 = 0: no force there.
Forces least_forces(const Balance& balance, const Wrench& wanted, const Forces& weight2);

/// Six loads of one foot as parts of their limits: along the rung; across it (two, together one
/// vector); three joints.
struct ForceBounds {
  bool active = false;
  Eigen::Matrix<double, 6, 3> rows = Eigen::Matrix<double, 6, 3>::Zero();
};

struct BoundedProblem {
  Balance balance;
  Wrench wanted;
  Forces weight2;
  PerLeg<ForceBounds> bounds;
  double max_load = 1.0;  ///< of each load
};

/// As least_forces(), with every load at most max_load. Balance is kept exactly; where the bounds
/// cannot be met the loads exceed them: judge the result. `scale_N` is a force of usual size.
Forces bounded_forces(const BoundedProblem& problem, double scale_N, int max_iterations);

}  // namespace climb
