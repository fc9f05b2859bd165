// SPDX-License-Identifier: BSD-3-Clause
// Weight, sum and sum of products of points: what has to be added up to get the mean and covariance
// of any union of nodes.
#pragma once

#include <Eigen/Core>

namespace ladder {

struct MomentSum {
  double weight = 0.0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double xx = 0.0, xy = 0.0, xz = 0.0, yy = 0.0, yz = 0.0, zz = 0.0;

  void add(const MomentSum& other) {
    weight += other.weight;
    sum += other.sum;
    xx += other.xx;
    xy += other.xy;
    xz += other.xz;
    yy += other.yy;
    yz += other.yz;
    zz += other.zz;
  }

  /// `weight` points with the given mean and covariance (its upper triangle).
  void add(double points, const Eigen::Vector3d& mean, const Eigen::Matrix3d& covariance) {
    weight += points;
    sum += points * mean;
    xx += points * (covariance(0, 0) + mean.x() * mean.x());
    xy += points * (covariance(0, 1) + mean.x() * mean.y());
    xz += points * (covariance(0, 2) + mean.x() * mean.z());
    yy += points * (covariance(1, 1) + mean.y() * mean.y());
    yz += points * (covariance(1, 2) + mean.y() * mean.z());
    zz += points * (covariance(2, 2) + mean.z() * mean.z());
  }

  /// Needs weight > 0, as covariance() does.
  Eigen::Vector3d mean() const { return sum / weight; }

  Eigen::Matrix3d covariance() const {
    const Eigen::Vector3d m = mean();
    Eigen::Matrix3d c;
    c(0, 0) = xx / weight - m.x() * m.x();
    c(1, 1) = yy / weight - m.y() * m.y();
    c(2, 2) = zz / weight - m.z() * m.z();
    c(0, 1) = c(1, 0) = xy / weight - m.x() * m.y();
    c(0, 2) = c(2, 0) = xz / weight - m.x() * m.z();
    c(1, 2) = c(2, 1) = yz / weight - m.y() * m.z();
    return c;
  }
};

}  // namespace ladder
