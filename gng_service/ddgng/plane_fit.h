// SPDX-License-Identifier: BSD-3-Clause
// Total-least-squares plane through points.
#pragma once

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

namespace ddgng {

struct PlaneFit {
  Eigen::Vector3d normal, short_axis;  ///< unit: of the smallest and the middle spread
  Eigen::Vector3d mean_m;

  static PlaneFit level(const Eigen::Vector3d& p) {
    return {Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitY(), p};
  }
  double distance_m(const Eigen::Vector3d& p) const { return normal.dot(p - mean_m); }
};

class PlaneSums {
 public:
  void add(const Eigen::Vector3d& p) {
    if (size_ == 0) origin_m_ = p;
    const Eigen::Vector3d offset_m = p - origin_m_;
    sum_m_ += offset_m;
    outer_m2_ += offset_m * offset_m.transpose();
    ++size_;
  }

  int size() const { return size_; }

  /// Needs at least one point.
  PlaneFit plane() const {
    const double weight = 1.0 / size_;
    const Eigen::Vector3d mean_m = sum_m_ * weight;
    const Eigen::Matrix3d covariance_m2 = outer_m2_ * weight - mean_m * mean_m.transpose();
    // compute(), not computeDirect(): only square roots, so the same bits everywhere.
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance_m2);
    const Eigen::Matrix3d& axes = solver.eigenvectors();
    return {axes.col(0), axes.col(1), origin_m_ + mean_m};
  }

 private:
  int size_ = 0;
  Eigen::Vector3d origin_m_ = Eigen::Vector3d::Zero();  ///< first point: keeps the sums small
  Eigen::Vector3d sum_m_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d outer_m2_ = Eigen::Matrix3d::Zero();
};

}  // namespace ddgng
