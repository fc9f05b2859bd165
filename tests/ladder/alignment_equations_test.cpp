// SPDX-License-Identifier: BSD-3-Clause
// The equations of heads and range against one dense least-squares problem in which every surface's
// shape is an unknown like the others.
#include "ladder/alignment_equations.h"

#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "base/rng.h"

namespace ladder {
namespace {

using Eigen::Vector3d;
using Sample = AlignmentEquations::Sample;

constexpr int kNumCommon = 6 * kNumHeads + RangeError::kNumKnots;
constexpr AlignmentPrior kPrior{0.01, 0.005, 0.003};

struct Plane3 {
  Vector3d normal = Vector3d::UnitX();
  std::vector<Sample> samples;
  std::array<double, 3> condition{0.0, 1.0, 0.5};
  double value = 0.001;
  double weight = 500.0;
};

Vector3d random_vector(base::Rng& rng) {
  const double x = rng.gaussian();
  const double y = rng.gaussian();
  return {x, y, rng.gaussian()};
}

std::vector<Plane3> random_planes(int num_planes) {
  base::Rng rng(7);
  std::vector<Plane3> planes(static_cast<std::size_t>(num_planes));
  for (Plane3& plane : planes) {
    plane.normal = random_vector(rng).normalized();
    for (int i = 0; i < 60; ++i) {
      Sample sample;
      sample.head = i % kNumHeads;
      sample.arm_m = random_vector(rng);
      sample.off_m = 0.01 * rng.gaussian();
      sample.shape = {1.0, rng.gaussian(), rng.gaussian()};
      sample.weight = 1e4 * (1.0 + rng.gaussian() * rng.gaussian());
      if (sample.weight > 0.0) plane.samples.push_back(sample);
    }
  }
  return planes;
}

Eigen::VectorXd dense_solution(const std::vector<Plane3>& planes) {
  const int n = kNumCommon + 3 * static_cast<int>(planes.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
  const auto add = [&](const Eigen::VectorXd& row, double value, double weight) {
    matrix += weight * row * row.transpose();
    right += weight * value * row;
  };
  for (int i = 0; i < kNumCommon; ++i) {
    double sigma = kPrior.range_m;
    if (i < 6 * kNumHeads) sigma = i % 6 < 3 ? kPrior.turn_rad : kPrior.shift_m;
    matrix(i, i) += 1.0 / (sigma * sigma);
  }
  for (std::size_t p = 0; p < planes.size(); ++p) {
    const int shape = kNumCommon + 3 * static_cast<int>(p);
    for (const Sample& sample : planes[p].samples) {
      Eigen::VectorXd row = Eigen::VectorXd::Zero(n);
      row.segment<3>(6 * sample.head) = sample.arm_m.cross(planes[p].normal);
      row.segment<3>(6 * sample.head + 3) = planes[p].normal;
      const double range_m = sample.arm_m.norm();
      const RangeError::Place at = RangeError::place(range_m);
      const double along = planes[p].normal.dot(sample.arm_m) / range_m;
      row[6 * kNumHeads + at.knot] = -along * (1.0 - at.share);
      row[6 * kNumHeads + at.knot + 1] = -along * at.share;
      for (int s = 0; s < 3; ++s) row[shape + s] = -sample.shape[s];
      add(row, -sample.off_m, sample.weight);
    }
    Eigen::VectorXd row = Eigen::VectorXd::Zero(n);
    for (int s = 0; s < 3; ++s) row[shape + s] = planes[p].condition[s];
    add(row, planes[p].value, planes[p].weight);
  }
  return matrix.ldlt().solve(right);
}

void add(const std::vector<Plane3>& planes, AlignmentEquations& equations) {
  for (const Plane3& plane : planes) {
    equations.begin_surface(plane.normal);
    for (const Sample& sample : plane.samples) equations.add(sample);
    equations.add_condition(plane.condition, plane.value, plane.weight);
    equations.end_surface();
  }
}

// Eliminating each shape at once gives what solving for all together gives.
TEST(AlignmentEquations, EqualTheDenseProblem) {
  const std::vector<Plane3> planes = random_planes(6);
  AlignmentEquations equations;
  add(planes, equations);
  HeadCorrections corrections;
  RangeError error;
  ASSERT_TRUE(equations.solve(kPrior, corrections, error));
  const Eigen::VectorXd expected = dense_solution(planes);
  for (int head = 0; head < kNumHeads; ++head) {
    EXPECT_LT((corrections[head].turn_rad - expected.segment<3>(6 * head)).norm(), 1e-8);
    EXPECT_LT((corrections[head].shift_m - expected.segment<3>(6 * head + 3)).norm(), 1e-8);
  }
  for (int knot = 0; knot < RangeError::kNumKnots; ++knot) {
    EXPECT_NEAR(error[knot], expected[6 * kNumHeads + knot], 1e-8);
  }
}

// Nothing seen: nothing corrected. Everything forgotten is nothing seen.
TEST(AlignmentEquations, NothingSeenNothingCorrected) {
  AlignmentEquations equations;
  HeadCorrections corrections;
  RangeError error;
  ASSERT_TRUE(equations.solve(kPrior, corrections, error));
  EXPECT_EQ(corrections[2].turn_rad.norm(), 0.0);
  add(random_planes(3), equations);
  equations.forget(0.0);
  ASSERT_TRUE(equations.solve(kPrior, corrections, error));
  EXPECT_EQ(corrections[2].turn_rad.norm(), 0.0);
  EXPECT_EQ(error.at(1.0), 0.0);
}

// What is not a number is answered with false, and the corrections stay as they were.
TEST(AlignmentEquations, NotANumberIsRefused) {
  AlignmentEquations equations;
  std::vector<Plane3> planes = random_planes(1);
  planes[0].samples[0].off_m = std::numeric_limits<double>::quiet_NaN();
  add(planes, equations);
  HeadCorrections corrections;
  corrections[1].shift_m.x() = 0.001;
  RangeError error;
  EXPECT_FALSE(equations.solve(kPrior, corrections, error));
  EXPECT_EQ(corrections[1].shift_m.x(), 0.001);
}

// Between knots linear, beyond them constant.
TEST(RangeError, IsPiecewiseLinear) {
  RangeError error;
  error[0] = 0.001;
  error[1] = 0.003;
  error[RangeError::kNumKnots - 1] = -0.002;
  EXPECT_DOUBLE_EQ(error.at(0.0), 0.001);
  EXPECT_NEAR(error.at(RangeError::kFirst_m + 0.5 * RangeError::kStep_m), 0.002, 1e-12);
  EXPECT_DOUBLE_EQ(error.at(100.0), -0.002);
}

}  // namespace
}  // namespace ladder
