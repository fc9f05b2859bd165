// SPDX-License-Identifier: BSD-3-Clause
// Plain loops: the order of additions, and with it the bits, must not depend on a CPU's caches.
#include "ladder/alignment_equations.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace ladder {

RangeError::Place RangeError::place(double range_m) {
  const double knots = std::clamp((range_m - kFirst_m) / kStep_m, 0.0, kNumKnots - 1.0);
  const int knot = std::min(static_cast<int>(knots), kNumKnots - 2);
  return {knot, knots - knot};
}

double RangeError::at(double range_m) const {
  const Place at = place(range_m);
  return (1.0 - at.share) * error_m_[at.knot] + at.share * error_m_[at.knot + 1];
}

void AlignmentEquations::clear() {
  sum_ = {};
}

void AlignmentEquations::forget(double keep) {
  for (int i = 0; i < kNumUnknowns; ++i) {
    for (int j = 0; j <= i; ++j) sum_.matrix[i][j] *= keep;
    sum_.right[i] *= keep;
  }
}

void AlignmentEquations::begin_surface(const Eigen::Vector3d& normal) {
  normal_ = normal;
  coupling_ = {};
  is_touched_.fill(false);
  shape_.setZero();
  shape_right_.setZero();
}

// normal . (p + turn x arm + shift - error ray) = shape . unknown shape
void AlignmentEquations::add(const Sample& sample) {
  const double range_m = std::sqrt(sample.arm_m.squaredNorm());
  if (!(range_m > 0.0)) return;
  const Eigen::Vector3d turned = sample.arm_m.cross(normal_);
  const double along = normal_.dot(sample.arm_m) / range_m;
  const RangeError::Place at = RangeError::place(range_m);
  const int first = kPerHead * sample.head;
  const int knot = kPerHead * kNumHeads + at.knot;
  const std::array<int, kNumInRow> index = {first,     first + 1, first + 2, first + 3,
                                            first + 4, first + 5, knot,      knot + 1};
  const std::array<double, kNumInRow> row = {turned.x(),
                                             turned.y(),
                                             turned.z(),
                                             normal_.x(),
                                             normal_.y(),
                                             normal_.z(),
                                             -along * (1.0 - at.share),
                                             -along * at.share};
  for (int a = 0; a < kNumInRow; ++a) {
    const int i = index[a];
    const double weighted = sample.weight * row[a];
    for (int b = 0; b <= a; ++b) sum_.matrix[i][index[b]] += weighted * row[b];
    sum_.right[i] -= weighted * sample.off_m;
    for (int s = 0; s < kMaxShape; ++s) coupling_[i][s] -= weighted * sample.shape[s];
    is_touched_[i] = true;
  }
  add_condition(sample.shape, sample.off_m, sample.weight);
}

void AlignmentEquations::add_condition(const std::array<double, kMaxShape>& coefficients,
                                       double value, double weight) {
  const Eigen::Vector3d row(coefficients[0], coefficients[1], coefficients[2]);
  shape_ += weight * row * row.transpose();
  shape_right_ += weight * value * row;
}

void AlignmentEquations::end_surface() {
  // A part of the shape that nothing shows, or that the surface has not, stays zero.
  constexpr double kRidge = 1e-3;  // far below 1 / variance of a point
  const Eigen::Matrix3d inverse = (shape_ + kRidge * Eigen::Matrix3d::Identity()).inverse();
  for (int i = 0; i < kNumUnknowns; ++i) {
    if (!is_touched_[i]) continue;
    const Eigen::Vector3d c(coupling_[i][0], coupling_[i][1], coupling_[i][2]);
    const Eigen::Vector3d eliminated = inverse * c;
    for (int j = 0; j <= i; ++j) {
      if (!is_touched_[j]) continue;
      sum_.matrix[i][j] -= eliminated.x() * coupling_[j][0] + eliminated.y() * coupling_[j][1] +
                           eliminated.z() * coupling_[j][2];
    }
    sum_.right[i] -= eliminated.dot(shape_right_);
  }
}

bool AlignmentEquations::solve(const AlignmentPrior& prior, HeadCorrections& corrections,
                               RangeError& error) {
  solution_ = sum_;
  for (int i = 0; i < kNumUnknowns; ++i) {
    const bool is_knot = i >= kPerHead * kNumHeads;
    const double sigma = is_knot            ? prior.range_m
                         : i % kPerHead < 3 ? prior.turn_rad
                                            : prior.shift_m;
    solution_.matrix[i][i] += 1.0 / (sigma * sigma);
  }
  if (!factorize()) return false;
  const Row& x = solution_.right;
  for (int head = 0; head < kNumHeads; ++head) {
    const int i = kPerHead * head;
    corrections[head].turn_rad = {x[i], x[i + 1], x[i + 2]};
    corrections[head].shift_m = {x[i + 3], x[i + 4], x[i + 5]};
  }
  for (int knot = 0; knot < RangeError::kNumKnots; ++knot) {
    error[knot] = x[kPerHead * kNumHeads + knot];
  }
  return true;
}

// Cholesky in place, then both triangles on the right side.
bool AlignmentEquations::factorize() {
  auto& l = solution_.matrix;
  Row& x = solution_.right;
  for (int j = 0; j < kNumUnknowns; ++j) {
    for (int i = j; i < kNumUnknowns; ++i) {
      double value = l[i][j];
      for (int k = 0; k < j; ++k) value -= l[i][k] * l[j][k];
      if (i == j) {
        if (!(value > 0.0) || !std::isfinite(value)) return false;
        l[j][j] = std::sqrt(value);
      } else {
        l[i][j] = value / l[j][j];
      }
    }
    double value = x[j];
    for (int k = 0; k < j; ++k) value -= l[j][k] * x[k];
    x[j] = value / l[j][j];
  }
  for (int j = kNumUnknowns - 1; j >= 0; --j) {
    double value = x[j];
    for (int i = j + 1; i < kNumUnknowns; ++i) value -= l[i][j] * x[i];
    x[j] = value / l[j][j];
    if (!std::isfinite(x[j])) return false;
  }
  return true;
}

}  // namespace ladder
