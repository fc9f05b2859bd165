// SPDX-License-Identifier: BSD-3-Clause
#include "climb/support.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

#include "climb/bounded_forces.h"
#include "climb/unit.h"

namespace climb {
namespace {

constexpr double kMarginSlack = 0.01;

bool valid(const Stance& stance) {
  if (!is_unit(stance.up_body)) return false;
  for (const Leg leg : kLegs) {
    const Contact& contact = stance.contacts[leg];
    if (!stance.angles_rad[leg].allFinite()) return false;
    if (!(contact.weight >= 0.0 && contact.weight <= 1.0)) return false;
    if (!is_unit(contact.rung_axis_body)) return false;
  }
  return true;
}

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& r) {
  Eigen::Matrix3d m;
  m << 0.0, -r.z(), r.y(), r.z(), 0.0, -r.x(), -r.y(), r.x(), 0.0;
  return m;
}

/// Forces and moments about the centre of mass (moments over `arm_m`, so both are forces).
Balance balance_of(const Stance& stance, const PerLeg<Eigen::Vector3d>& feet_m,
                   const Eigen::Vector3d& center_m, double arm_m) {
  Balance balance = Balance::Zero();
  for (const Leg leg : kLegs) {
    if (!stance.contacts[leg].holds()) continue;
    balance.block<3, 3>(0, 3 * leg) = Eigen::Matrix3d::Identity();
    balance.block<3, 3>(3, 3 * leg) = cross_matrix(feet_m[leg] - center_m) / arm_m;
  }
  return balance;
}

/// The smaller of `margin` and limit / load; tells whether it became smaller.
bool lowers(double& margin, double load, double limit) {
  const double ratio = limit / std::max(load, 1e-12);
  if (ratio >= margin) return false;
  margin = ratio;
  return true;
}

}  // namespace

const char* name(Burden burden) {
  switch (burden) {
    case Burden::kBorne:
      return "borne";
    case Burden::kNotFinite:
      return "not finite";
    case Burden::kNoContact:
      return "no contact";
    case Burden::kUnbalanced:
      return "unbalanced";
    case Burden::kGrip:
      return "grip";
    case Burden::kFriction:
      return "friction";
    case Burden::kTorque:
      return "torque";
  }
  return "?";
}

Support::Support(const RobotParams& robot, const SupportParams& params)
    : kinematics_(robot),
      mass_(robot),
      params_(params),
      max_torque_Nm_(robot.abduction.max_torque_Nm, robot.hip.max_torque_Nm,
                     robot.knee_bend.max_torque_Nm) {}

double Support::weight_N() const {
  return mass_.total_kg() * params_.gravity_m_s2;
}

Support::Problem Support::problem_of(const Stance& stance) const {
  Problem problem;
  PerLeg<Eigen::Vector3d> feet_m;
  for (const Leg leg : kLegs) {
    feet_m[leg] = kinematics_.foot_m(leg, stance.angles_rad[leg]);
    const double weight = stance.contacts[leg].holds() ? stance.contacts[leg].weight : 0.0;
    problem.weight2.segment<3>(3 * leg).setConstant(weight * weight);
    if (weight > 0.0) ++problem.num_contacts;
  }
  problem.balance =
      balance_of(stance, feet_m, mass_.center_m(stance.angles_rad), params_.moment_arm_m);
  problem.wanted << stance.up_body.normalized() * weight_N(), Eigen::Vector3d::Zero();
  return problem;
}

ContactForces Support::forces_of(const Problem& problem, const Forces& forces_N) const {
  ContactForces result;
  result.num_contacts = problem.num_contacts;
  for (const Leg leg : kLegs) result.force_N[leg] = forces_N.segment<3>(3 * leg);
  const Wrench missing = problem.wanted - problem.balance * forces_N;
  result.force_residual_N = missing.head<3>().norm();
  result.moment_residual_Nm = missing.tail<3>().norm() * params_.moment_arm_m;
  return result;
}

ContactForces Support::distribute(const Stance& stance) const {
  if (!valid(stance)) return ContactForces();
  const Problem problem = problem_of(stance);
  return forces_of(problem, least_forces(problem.balance, problem.wanted, problem.weight2));
}

SupportVerdict Support::judge(const Stance& stance, const ContactForces& forces) const {
  SupportVerdict verdict;
  verdict.forces = forces;
  if (forces.num_contacts == 0) return verdict;
  if (!(forces.force_residual_N <= params_.max_force_residual_N &&
        forces.moment_residual_Nm <= params_.max_moment_residual_Nm)) {
    verdict.burden = Burden::kUnbalanced;
    return verdict;
  }
  verdict.margin = std::numeric_limits<double>::infinity();
  Burden weakest = Burden::kGrip;
  const auto weigh = [&](Leg leg, Burden burden, double load, double limit) {
    if (!lowers(verdict.margin, load, limit)) return;
    verdict.weakest = leg;
    weakest = burden;
  };
  const PerLeg<LegAngles> torques = torques_Nm(stance, forces);
  for (const Leg leg : kLegs) {
    if (!stance.contacts[leg].holds()) continue;
    const Eigen::Vector3d& axis = stance.contacts[leg].rung_axis_body;
    const double along_N = forces.force_N[leg].dot(axis);
    weigh(leg, Burden::kGrip, (forces.force_N[leg] - along_N * axis).norm(), params_.grip_alarm_N);
    weigh(leg, Burden::kFriction, std::abs(along_N), params_.friction * params_.squeeze_N);
    for (int joint = 0; joint < kNumLegJoints; ++joint) {
      weigh(leg, Burden::kTorque, std::abs(torques[leg][joint]), max_torque_Nm_[joint]);
    }
  }
  verdict.burden = verdict.margin >= 1.0 ? Burden::kBorne : weakest;
  return verdict;
}

SupportVerdict Support::check(const Stance& stance) const {
  if (!valid(stance)) {
    SupportVerdict refused;
    refused.burden = Burden::kNotFinite;
    return refused;
  }
  const SupportVerdict least = judge(stance, distribute(stance));
  const bool may_be_better = least.burden != Burden::kUnbalanced && least.forces.num_contacts > 0;
  if (least.margin >= params_.min_margin || !may_be_better) return least;
  SupportVerdict bounded = judge(stance, distribute_bounded(stance));
  bounded.bounded = true;
  return bounded.margin > least.margin ? bounded : least;
}

ContactForces Support::distribute_bounded(const Stance& stance) const {
  const Problem problem = problem_of(stance);
  PerLeg<ForceBounds> bounds;
  for (const Leg leg : kLegs) {
    if (!stance.contacts[leg].holds()) continue;
    const Eigen::Vector3d axis = stance.contacts[leg].rung_axis_body;
    const Eigen::Vector3d across = axis.unitOrthogonal();
    const Eigen::Matrix3d jacobian = kinematics_.jacobian(leg, stance.angles_rad[leg]);
    ForceBounds& bound = bounds[leg];
    bound.active = true;
    bound.rows.row(0) = axis.transpose() / (params_.friction * params_.squeeze_N);
    bound.rows.row(1) = across.transpose() / params_.grip_alarm_N;
    bound.rows.row(2) = axis.cross(across).transpose() / params_.grip_alarm_N;
    for (int joint = 0; joint < kNumLegJoints; ++joint) {
      bound.rows.row(3 + joint) = jacobian.col(joint).transpose() / max_torque_Nm_[joint];
    }
  }
  const BoundedProblem bounded{problem.balance, problem.wanted, problem.weight2, bounds,
                               1.0 / params_.min_margin};
  return forces_of(problem, bounded_forces(bounded, weight_N(), params_.max_iterations));
}

SupportVerdict Support::check_without(const Stance& stance, Leg lifted) const {
  Stance remaining = stance;
  remaining.contacts[lifted].weight = 0.0;
  return check(remaining);
}

bool Support::is_ample(const SupportVerdict& verdict) const {
  return verdict.margin >= params_.min_margin - kMarginSlack;
}

RungLoss Support::check_rung_loss(const Stance& stance) const {
  RungLoss worst;
  bool first = true;
  const auto key = [](const RungLoss& loss) {
    // Order of badness: falls, then fewer front claws, fewer claws, less margin.
    return std::array<double, 4>{loss.survives ? 1.0 : 0.0, double(loss.num_front_remaining),
                                 double(loss.num_remaining), loss.margin};
  };
  for (const Leg broken : kLegs) {
    if (!stance.contacts[broken].holds()) continue;
    Stance rest = stance;
    RungLoss loss;
    loss.worst_rung_id = stance.contacts[broken].rung_id;
    for (const Leg leg : kLegs) {
      if (rest.contacts[leg].rung_id == loss.worst_rung_id) rest.contacts[leg].weight = 0.0;
      if (!rest.contacts[leg].holds()) continue;
      ++loss.num_remaining;
      if (is_front(leg)) ++loss.num_front_remaining;
    }
    const SupportVerdict verdict = check(rest);
    loss.margin = verdict.margin;
    // Two claws swing until they hang below their line: nothing static to ask of them.
    loss.survives = loss.num_front_remaining >= 1 && loss.num_remaining >= 2 &&
                    (loss.num_remaining == 2 || verdict.margin >= 1.0);
    if (first || key(loss) < key(worst)) worst = loss;
    first = false;
  }
  if (first) worst.survives = false;  // nothing holds at all
  return worst;
}

PerLeg<LegAngles> Support::torques_Nm(const Stance& stance, const ContactForces& forces) const {
  PerLeg<LegAngles> torques;
  for (const Leg leg : kLegs) {
    torques[leg] = stance.contacts[leg].holds() && stance.angles_rad[leg].allFinite()
                       ? LegAngles(-kinematics_.jacobian(leg, stance.angles_rad[leg]).transpose() *
                                   forces.force_N[leg])
                       : LegAngles(LegAngles::Zero());
  }
  return torques;
}

}  // namespace climb
