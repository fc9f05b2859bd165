// SPDX-License-Identifier: BSD-3-Clause
#include "tests/climb/kdl_leg.h"

#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainiksolverpos_lma.hpp>
#include <kdl/chainjnttojacsolver.hpp>

namespace kdl_leg {
namespace {

KDL::Chain chain_of(const Shape& shape) {
  KDL::Chain chain;
  const KDL::Vector hip(shape.hip_m[0], shape.hip_m[1], shape.hip_m[2]);
  chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::None), KDL::Frame(hip)));
  chain.addSegment(
      KDL::Segment(KDL::Joint(KDL::Joint::RotX), KDL::Frame(KDL::Vector(0.0, shape.side_m, 0.0))));
  chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::RotY),
                                KDL::Frame(KDL::Vector(0.0, 0.0, -shape.thigh_m))));
  chain.addSegment(KDL::Segment(
      KDL::Joint(KDL::Joint::RotY),
      KDL::Frame(KDL::Rotation::RotY(shape.claw_rad), KDL::Vector(0.0, 0.0, -shape.shank_m))));
  return chain;
}

KDL::JntArray joints_of(const Triple& angles_rad) {
  KDL::JntArray joints(3);
  for (unsigned i = 0; i < 3; ++i) joints(i) = angles_rad[i];
  return joints;
}

Eigen::Matrix<double, 6, 1> position_only() {
  Eigen::Matrix<double, 6, 1> weights;
  weights << 1.0, 1.0, 1.0, 0.0, 0.0, 0.0;
  return weights;
}

}  // namespace

struct KdlLeg::Solvers {
  explicit Solvers(const Shape& shape)
      : chain(chain_of(shape)),
        forward(chain),
        jacobian(chain),
        inverse(chain, position_only(), 1e-11, 500, 1e-15) {}
  KDL::Chain chain;
  KDL::ChainFkSolverPos_recursive forward;
  KDL::ChainJntToJacSolver jacobian;
  KDL::ChainIkSolverPos_LMA inverse;
};

KdlLeg::KdlLeg(const Shape& shape) : solvers_(std::make_unique<Solvers>(shape)) {}
KdlLeg::~KdlLeg() = default;

Pose KdlLeg::forward(const Triple& angles_rad) const {
  KDL::Frame frame;
  solvers_->forward.JntToCart(joints_of(angles_rad), frame);
  Pose pose;
  for (int i = 0; i < 3; ++i) {
    pose.foot_m[i] = frame.p(i);
    for (int axis = 0; axis < 3; ++axis) pose.claw_axes[axis][i] = frame.M(i, axis);
  }
  return pose;
}

std::array<Triple, 3> KdlLeg::jacobian(const Triple& angles_rad) const {
  KDL::Jacobian jacobian(3);
  solvers_->jacobian.JntToJac(joints_of(angles_rad), jacobian);
  std::array<Triple, 3> columns{};
  for (unsigned joint = 0; joint < 3; ++joint) {
    for (unsigned i = 0; i < 3; ++i) columns[joint][i] = jacobian(i, joint);
  }
  return columns;
}

bool KdlLeg::inverse(const Triple& foot_m, const Triple& start_rad, Triple& angles_rad) const {
  KDL::JntArray solution(3);
  const KDL::Frame wish(KDL::Vector(foot_m[0], foot_m[1], foot_m[2]));
  if (solvers_->inverse.CartToJnt(joints_of(start_rad), wish, solution) != 0) return false;
  for (unsigned i = 0; i < 3; ++i) angles_rad[i] = solution(i);
  return true;
}

}  // namespace kdl_leg
