// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/plant/body_pose.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

namespace simulator {
namespace {

/// Four points about the body remember where it was, softly: 1e-6 of a foot's stiffness.
constexpr double kMemory_N_m = 0.02;
constexpr double kMemoryArm_m = 0.3;

class PointSums {
 public:
  void add(const Support& support) {
    const double w = support.stiffness_N_m;
    weight_ += w;
    body_ += w * support.p_body_m;
    world_ += w * support.p_world_m;
    cross_ += w * support.p_body_m * support.p_world_m.transpose();
  }

  Eigen::Isometry3d pose() const {
    const Eigen::Vector3d body = body_ / weight_;
    const Eigen::Vector3d world = world_ / weight_;
    const Eigen::Matrix3d s = cross_ - weight_ * body * world.transpose();
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = rotation(s);
    pose.translation() = world - pose.linear() * body;
    return pose;
  }

 private:
  /// Horn, section 4: the eigenvector of the largest eigenvalue is the rotation's quaternion.
  static Eigen::Matrix3d rotation(const Eigen::Matrix3d& s) {
    Eigen::Matrix4d n;
    n << s.trace(), s(1, 2) - s(2, 1), s(2, 0) - s(0, 2), s(0, 1) - s(1, 0),  //
        s(1, 2) - s(2, 1), s(0, 0) - s(1, 1) - s(2, 2), s(0, 1) + s(1, 0), s(2, 0) + s(0, 2),
        s(2, 0) - s(0, 2), s(0, 1) + s(1, 0), s(1, 1) - s(0, 0) - s(2, 2), s(1, 2) + s(2, 1),
        s(0, 1) - s(1, 0), s(2, 0) + s(0, 2), s(1, 2) + s(2, 1), s(2, 2) - s(0, 0) - s(1, 1);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(n);
    const Eigen::Vector4d q = solver.eigenvectors().col(3);
    return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
  }

  double weight_ = 0.0;
  Eigen::Vector3d body_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d world_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d cross_ = Eigen::Matrix3d::Zero();
};

}  // namespace

Eigen::Isometry3d balanced_pose(std::span<const Support> supports,
                                const Eigen::Isometry3d& previous) {
  PointSums sums;
  const Eigen::Vector3d memory[] = {{kMemoryArm_m, 0.0, 0.0},
                                    {-kMemoryArm_m, 0.0, 0.0},
                                    {0.0, kMemoryArm_m, 0.0},
                                    {0.0, 0.0, kMemoryArm_m}};
  for (const Eigen::Vector3d& point : memory) sums.add({point, previous * point, kMemory_N_m});
  for (const Support& support : supports) sums.add(support);
  return sums.pose();
}

std::vector<Eigen::Vector3d> weight_shares(std::span<const Eigen::Vector3d> contacts_m,
                                           const Eigen::Vector3d& centre_of_mass_m,
                                           double weight_N) {
  const auto num = static_cast<Eigen::Index>(contacts_m.size());
  std::vector<Eigen::Vector3d> forces(contacts_m.size(), Eigen::Vector3d::Zero());
  if (num == 0) return forces;
  Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 12> wrench(6, 3 * num);
  for (Eigen::Index i = 0; i < num; ++i) {
    const Eigen::Vector3d arm = contacts_m[static_cast<std::size_t>(i)] - centre_of_mass_m;
    wrench.block<3, 3>(0, 3 * i).setIdentity();
    wrench.block<3, 3>(3, 3 * i) << 0.0, -arm.z(), arm.y(),  //
        arm.z(), 0.0, -arm.x(),                              //
        -arm.y(), arm.x(), 0.0;
  }
  Eigen::Matrix<double, 6, 1> wanted = Eigen::Matrix<double, 6, 1>::Zero();
  wanted[2] = weight_N;
  const Eigen::VectorXd solution = wrench.completeOrthogonalDecomposition().solve(wanted);
  for (Eigen::Index i = 0; i < num; ++i) {
    forces[static_cast<std::size_t>(i)] = solution.segment<3>(3 * i);
  }
  return forces;
}

}  // namespace simulator
