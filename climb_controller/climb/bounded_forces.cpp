// SPDX-License-Identifier: BSD-3-Clause
#include "climb/bounded_forces.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace climb {
namespace {

constexpr int kNumForces = 3 * kNumLegs;
constexpr int kNumLoads = 6 * kNumLegs;
using Loads = Eigen::Matrix<double, kNumLoads, 1>;
using Square = Eigen::Matrix<double, kNumForces, kNumForces>;
using Square6 = Eigen::Matrix<double, 6, 6>;

/// Of a symmetric matrix that is not negative; directions of no strength (contacts on one line)
/// are left out.
Square6 pseudo_inverse(const Square6& symmetric) {
  constexpr double kLeastStrength = 1e-10;
  Eigen::SelfAdjointEigenSolver<Square6> solver;
  solver.compute(symmetric);
  const Wrench& strengths = solver.eigenvalues();
  const double cut = kLeastStrength * std::max(strengths.maxCoeff(), 1e-300);
  Wrench inverted;
  for (int i = 0; i < 6; ++i) inverted[i] = strengths[i] > cut ? 1.0 / strengths[i] : 0.0;
  return solver.eigenvectors() * inverted.asDiagonal() * solver.eigenvectors().transpose();
}

/// The nearest loads within the bounds: an interval, a disc, three intervals per leg.
void bound(Loads& loads, double max_load) {
  for (int leg = 0; leg < kNumLegs; ++leg) {
    auto own = loads.segment<6>(6 * leg);
    const double across = std::hypot(own[1], own[2]);
    if (across > max_load) own.segment<2>(1) *= max_load / across;
    own[0] = std::clamp(own[0], -max_load, max_load);
    for (int i = 3; i < 6; ++i) own[i] = std::clamp(own[i], -max_load, max_load);
  }
}

}  // namespace

Forces least_forces(const Balance& balance, const Wrench& wanted, const Forces& weight2) {
  const Eigen::Matrix<double, kNumForces, 6> weighted = weight2.asDiagonal() * balance.transpose();
  return weighted * (pseudo_inverse(balance * weighted) * wanted);
}

Forces bounded_forces(const BoundedProblem& problem, double scale_N, int max_iterations) {
  constexpr double kPenalty = 1.0;
  constexpr double kTolerance = 1e-6;  // of loads, parts of their limits
  // x = forces / scale; minimise x' P x / 2 with balance x = wanted / scale, loads = C x bounded.
  Eigen::Matrix<double, kNumLoads, kNumForces> loads_of =
      Eigen::Matrix<double, kNumLoads, kNumForces>::Zero();
  Square cost = Square::Zero();
  for (int leg = 0; leg < kNumLegs; ++leg) {
    if (problem.bounds[leg].active) {
      loads_of.block<6, 3>(6 * leg, 3 * leg) = scale_N * problem.bounds[leg].rows;
    }
  }
  for (int i = 0; i < kNumForces; ++i) {
    cost(i, i) = problem.weight2[i] > 0.0 ? 1.0 / problem.weight2[i] : 1.0;
  }
  const Square inverse =
      Square(cost + kPenalty * loads_of.transpose() * loads_of).llt().solve(Square::Identity());
  const Eigen::Matrix<double, kNumForces, 6> spread = inverse * problem.balance.transpose();
  const Square6 stiffness = pseudo_inverse(problem.balance * spread);
  const Wrench wanted = problem.wanted / scale_N;

  Forces x = Forces::Zero();
  Loads bounded = Loads::Zero();
  Loads dual = Loads::Zero();  // scaled by the penalty
  for (int i = 0; i < max_iterations; ++i) {
    const Forces free = inverse * (kPenalty * (loads_of.transpose() * (bounded - dual)));
    x = free + spread * (stiffness * (wanted - problem.balance * free));
    const Loads loads = loads_of * x;
    const Loads last = bounded;
    bounded = loads + dual;
    bound(bounded, problem.max_load);
    dual += loads - bounded;
    const double primal_gap = (loads - bounded).cwiseAbs().maxCoeff();
    const double dual_gap = (bounded - last).cwiseAbs().maxCoeff();
    if (primal_gap < kTolerance && dual_gap < kTolerance) break;
  }
  return scale_N * x;
}

}  // namespace climb
