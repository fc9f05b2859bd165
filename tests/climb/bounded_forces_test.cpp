// SPDX-License-Identifier: BSD-3-Clause
// Least forces against a dense solver; bounded ones against a search over a grid.
#include "climb/bounded_forces.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "tests/climb/robot_poses.h"

namespace climb {
namespace {

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& r) {
  Eigen::Matrix3d m;
  m << 0, -r.z(), r.y(), r.z(), 0, -r.x(), -r.y(), r.x(), 0;
  return m;
}

/// Feet at random places; `num_contacts` of them hold.
BoundedProblem random_problem(base::Rng& rng, int num_contacts) {
  BoundedProblem problem;
  problem.balance.setZero();
  problem.weight2.setZero();
  for (int leg = 0; leg < num_contacts; ++leg) {
    const Eigen::Vector3d foot = climb_tests::in_box(rng, 0.4);
    problem.balance.block<3, 3>(0, 3 * leg) = Eigen::Matrix3d::Identity();
    problem.balance.block<3, 3>(3, 3 * leg) = cross_matrix(foot) / 0.25;
    const double weight = climb_tests::between(rng, 0.3, 1.0);
    problem.weight2.segment<3>(3 * leg).setConstant(weight * weight);
    problem.bounds[leg].active = true;
    for (int row = 0; row < 6; ++row) {
      problem.bounds[leg].rows.row(row) = climb_tests::in_box(rng, 1.0 / 60.0).transpose();
    }
  }
  problem.wanted << 78.0, 0.0, 0.0, 0.0, 0.0, 0.0;
  return problem;
}

double most_load(const BoundedProblem& problem, const Forces& forces) {
  double most = 0.0;
  for (int leg = 0; leg < kNumLegs; ++leg) {
    if (!problem.bounds[leg].active) continue;
    const Wrench loads = problem.bounds[leg].rows * forces.segment<3>(3 * leg);
    most = std::max({most, std::abs(loads[0]), std::hypot(loads[1], loads[2]),
                     loads.tail<3>().cwiseAbs().maxCoeff()});
  }
  return most;
}

double cost(const BoundedProblem& problem, const Forces& forces) {
  double sum = 0.0;
  for (int i = 0; i < forces.size(); ++i) {
    if (problem.weight2[i] > 0.0) sum += forces[i] * forces[i] / problem.weight2[i];
  }
  return sum;
}

// Nothing holds, nothing is wanted: no forces, no NaN.
TEST(LeastForces, OfNothingIsNothing) {
  Wrench wanted = Wrench::Zero();
  EXPECT_EQ(least_forces(Balance::Zero(), wanted, Forces::Zero()), Forces::Zero());
  wanted[0] = 78.0;
  EXPECT_EQ(least_forces(Balance::Zero(), wanted, Forces::Ones()), Forces::Zero());
}

// For 1 to 4 contacts the closed form is the minimum-norm least-squares solution of a complete
// orthogonal decomposition in weighted unknowns.
TEST(LeastForces, IsTheMinimumNormSolution) {
  base::Rng rng(50);
  for (int i = 0; i < 2000; ++i) {
    const BoundedProblem problem = random_problem(rng, 1 + i % 4);
    const Forces root = problem.weight2.cwiseSqrt();
    const Eigen::MatrixXd weighted = problem.balance * root.asDiagonal();
    const Eigen::VectorXd expected =
        root.asDiagonal() * Eigen::VectorXd(weighted.completeOrthogonalDecomposition().solve(
                                Eigen::VectorXd(problem.wanted)));
    const Forces forces = least_forces(problem.balance, problem.wanted, problem.weight2);
    ASSERT_LE((forces - expected).norm(), 1e-6 * (1.0 + expected.norm())) << i;
  }
}

// Bounds that do not bind change nothing.
TEST(BoundedForces, WithoutBindingBoundsAreTheLeastOnes) {
  base::Rng rng(51);
  for (int i = 0; i < 200; ++i) {
    BoundedProblem problem = random_problem(rng, 3 + i % 2);
    const Forces least = least_forces(problem.balance, problem.wanted, problem.weight2);
    problem.max_load = 1.5 * most_load(problem, least);
    EXPECT_LE((bounded_forces(problem, 78.0, 4000) - least).norm(), 1e-3 * least.norm());
  }
}

// Three contacts leave three free directions: no point of a fine grid over them is within the
// bounds and cheaper than the answer; the answer is within them where the grid finds any point
// clearly within.
TEST(BoundedForces, NoGridPointIsBetter) {
  base::Rng rng(52);
  int num_binding = 0;
  for (int i = 0; i < 60; ++i) {
    BoundedProblem problem = random_problem(rng, 3);
    const Forces least = least_forces(problem.balance, problem.wanted, problem.weight2);
    problem.max_load = 0.85 * most_load(problem, least);
    const Eigen::MatrixXd balance = problem.balance.leftCols<9>();
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(balance, Eigen::ComputeFullV);
    if (svd.singularValues()[5] < 0.05) continue;  // three feet all but on one line
    const Eigen::Matrix<double, 9, 3> free = svd.matrixV().rightCols<3>();
    const auto forces_at = [&](const Eigen::Vector3d& along) {
      Forces forces = least;
      forces.head<9>() += free * along;
      return forces;
    };
    constexpr int kHalf = 25;
    constexpr double kStep_N = 3.0;
    double best = climb_tests::kInfinity;
    bool clearly = false;
    for (int a = -kHalf; a <= kHalf; ++a) {
      for (int b = -kHalf; b <= kHalf; ++b) {
        for (int c = -kHalf; c <= kHalf; ++c) {
          const Forces forces = forces_at(kStep_N * Eigen::Vector3d(a, b, c));
          const double load = most_load(problem, forces);
          if (load <= problem.max_load) best = std::min(best, cost(problem, forces));
          clearly = clearly || load <= 0.97 * problem.max_load;
        }
      }
    }
    if (!clearly) continue;
    ++num_binding;
    const Forces forces = bounded_forces(problem, 78.0, 4000);
    EXPECT_LE((problem.balance * forces - problem.wanted).norm(), 1e-8);
    EXPECT_LE(most_load(problem, forces), problem.max_load * 1.002) << i;
    EXPECT_LE(cost(problem, forces), best * 1.001) << i;
  }
  EXPECT_GE(num_binding, 15);
}

}  // namespace
}  // namespace climb
