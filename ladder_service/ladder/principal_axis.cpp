// SPDX-License-Identifier: BSD-3-Clause
#include "ladder/principal_axis.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace ladder {

PrincipalAxis principal_axis(const Eigen::Matrix3d& covariance) {
  PrincipalAxis axis;
  const double trace = covariance.trace();
  if (!(trace > 0.0)) return axis;
  // Every squaring squares the ratio of the eigenvalues: after six of them all columns point along
  // the longest axis.
  constexpr int kNumSquarings = 6;
  const Eigen::Matrix3d scaled = covariance / trace;
  Eigen::Matrix3d power = scaled;
  for (int i = 0; i < kNumSquarings; ++i) {
    const Eigen::Matrix3d square = power * power;
    power = square / square.trace();
  }
  int column = 0;
  for (int i = 1; i < 3; ++i) {
    if (power(i, i) > power(column, column)) column = i;
  }
  axis.direction = power.col(column) / std::sqrt(power.col(column).squaredNorm());
  const double first = axis.direction.dot(scaled * axis.direction);
  // The other two have the sum trace - first and the product determinant / first.
  const double half_sum = 0.5 * std::max(0.0, 1.0 - first);
  const double product = scaled.determinant() / first;
  axis.first_m2 = first * trace;
  axis.second_m2 = (half_sum + std::sqrt(std::max(0.0, half_sum * half_sum - product))) * trace;
  return axis;
}

}  // namespace ladder
