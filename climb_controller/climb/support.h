// SPDX-License-Identifier: BSD-3-Clause
// Statics of the hanging robot: which forces the rungs exert on the feet that hold, whether claws,
// friction and drives bear them, and what would remain if one rung broke. A held rung is a point
// contact (a claw turns freely round its rung); legs are rigid; nothing moves.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "climb/bounded_forces.h"
#include "climb/leg_kinematics.h"
#include "climb/mass_model.h"
#include "climb/params.h"

namespace climb {

struct Contact {
  double weight = 0.0;  ///< 0 = does not hold .. 1 = bears its full share; smooth while loading
  int rung_id = -1;
  Eigen::Vector3d rung_axis_body = Eigen::Vector3d::UnitY();  ///< unit

  bool holds() const { return weight > 1e-3; }
};

struct Stance {
  PerLeg<LegAngles> angles_rad = {LegAngles::Zero(), LegAngles::Zero(), LegAngles::Zero(),
                                  LegAngles::Zero()};
  PerLeg<Contact> contacts;
  Eigen::Vector3d up_body = Eigen::Vector3d::UnitX();  ///< unit, against gravity
};

/// Forces of the rungs on the feet, body frame; zero where nothing holds.
struct ContactForces {
  PerLeg<Eigen::Vector3d> force_N = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
                                     Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  int num_contacts = 0;
  double force_residual_N = 0.0;    ///< weight that nothing bears
  double moment_residual_Nm = 0.0;  ///< moment that nothing bears (two contacts: about their line)
};

enum class Burden : std::uint8_t {
  kBorne,
  kNotFinite,
  kNoContact,
  kUnbalanced,  ///< no forces at these contacts balance the weight
  kGrip,        ///< a claw beyond grip_alarm_N across its rung
  kFriction,    ///< a claw slips along its rung
  kTorque       ///< a drive beyond its continuous torque
};

const char* name(Burden burden);

struct SupportVerdict {
  Burden burden = Burden::kNoContact;  ///< what gives way first, or kBorne (margin >= 1)
  double margin = 0.0;                 ///< least limit / load over all contacts; 0 when unbalanced
  Leg weakest = kFrontLeft;            ///< where that is
  bool bounded = false;                ///< the min-norm forces were beyond the wanted margin
  ContactForces forces;
};

/// What remains when the rung of the worst choice breaks.
struct RungLoss {
  bool survives = true;  ///< for every rung: a front claw and one more stay
  int worst_rung_id = -1;
  int num_remaining = 0;  ///< contacts after that loss
  int num_front_remaining = 0;
  double margin = 0.0;  ///< of the remaining contacts at rest; 0 = they swing before they hold
};

class Support {
 public:
  Support(const RobotParams& robot, const SupportParams& params);

  /// Weighted min-norm forces: least sum of |f|^2 / weight^2 that balances the weight.
  /// 0 contacts give zero forces; 1 or 2 contacts leave a moment, which is told.
  ContactForces distribute(const Stance& stance) const;

  /// As distribute(), but where its margin is below min_margin the least forces within all limits
  /// are sought (bounded; for planning, not for every cycle).
  SupportVerdict check(const Stance& stance) const;

  /// check() without one leg, whose contact is taken away: may it be lifted?
  SupportVerdict check_without(const Stance& stance, Leg lifted) const;

  /// With the margin that a limb may be lifted with. Bounded forces come near it from below: a
  /// hundredth less is enough.
  bool is_ample(const SupportVerdict& verdict) const;

  /// Every rung in turn taken away with all claws on it.
  RungLoss check_rung_loss(const Stance& stance) const;

  /// Joint torques that bear `forces`: tau = -J^T f (gravity feed-forward).
  PerLeg<LegAngles> torques_Nm(const Stance& stance, const ContactForces& forces) const;

  double weight_N() const;

 private:
  struct Problem {
    Balance balance;
    Wrench wanted;
    Forces weight2;
    int num_contacts = 0;
  };
  Problem problem_of(const Stance& stance) const;
  ContactForces forces_of(const Problem& problem, const Forces& forces_N) const;
  SupportVerdict judge(const Stance& stance, const ContactForces& forces) const;
  ContactForces distribute_bounded(const Stance& stance) const;

  LegKinematics kinematics_;
  MassModel mass_;
  SupportParams params_;
  LegAngles max_torque_Nm_;  ///< per joint
};

}  // namespace climb
