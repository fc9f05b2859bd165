// SPDX-License-Identifier: BSD-3-Clause
// When a claw loses its rung while another limb is in the air: everything freezes, and that limb
// alone is put down. And the other way round: claws opened on purpose, in the dock.
#include <Eigen/LU>

#include "climb/controller.h"
#include "climb/mass_model.h"

namespace climb {

using S = ControllerState;
using E = ControllerEvent;

bool Controller::lacks_grasps() const {
  if (!following_ || !hangs_ || !params_.on_ladder || parking_) return false;
  int num_held = 0;
  for (const LimbCycle& limb : limbs_) num_held += is_confirmed(limb.state()) ? 1 : 0;
  if (num_held >= 3) return false;
  // The limb in the air may become the third.
  const std::optional<Leg> in_air = moving_leg();
  const bool may_be_saved = num_held == 2 && in_air && !limbs_[*in_air].failed();
  return !may_be_saved || put_down_vain_;
}

bool Controller::may_put_down() const {
  bool is_lost = false;
  for (const LimbCycle& limb : limbs_) {
    is_lost = is_lost || limb.state() == LimbState::kSupportLost;
  }
  if (!is_lost) return false;
  const FaultFlags others = faults_ & ~flag(Fault::kStanceLost);
  return state_ == S::kFaultHold && reason_ == Fault::kStanceLost && following_ &&
         failsafe(others, S::kClimbing).reaction < Reaction::kFaultHold;
}

void Controller::work_put_down(const ControllerInput& input) {
  const std::optional<Leg> leg = moving_leg();
  if (!leg || !may_put_down()) {
    // Ended for good, though what ended it may pass: only a reset begins anew.
    put_down_vain_ = put_down_vain_ || leg.has_value();
    putting_down_.reset();
    return;
  }
  LimbCycle& limb = limbs_[*leg];
  if (putting_down_ && limb.wants_goal()) limb.give_up();
  if (putting_down_ || put_down_vain_ || in_state_s_ < params_.put_down_after_s) return;

  const RobotNow now = robot_now(input);
  const Eigen::Isometry3d T_now_before =
      now.pose.T_odom_body().inverse() * T_odom_body_before_;  // the body gave way meanwhile
  std::array<LimbGoal, 2> places;
  std::size_t num_places = 0;
  const auto offer = [&](const LimbGoal& place) {
    for (const LimbCycle& other : limbs_) {
      const bool is_lost = other.state() == LimbState::kSupportLost;
      if (is_lost && other.lost_rung_id() == place.rung_id) return;
    }
    places[num_places++] = moved(T_now_before, place);
  };
  if (limb.home()) offer(*limb.home());
  const bool has_other_goal = !limb.home() || limb.goal().rung_id != limb.home()->rung_id;
  if (has_other_goal) offer(limb.goal());
  const std::optional<LimbGoal> place =
      planner_.put_down(*leg, now, std::span(places).first(num_places));
  put_down_vain_ = !place;
  if (!place) return;
  limb.put_down(*place);
  putting_down_ = leg;
}

void Controller::work_disarming(const ControllerInput& input) {
  const bool is_down = !input.drives_enabled && in_state_s_ > params_.gate.period_s;
  if (is_down) take(E::kDisarmed);
  if (!parking_ || moving_leg()) return;
  bool all_hold = true;
  for (const LimbCycle& limb : limbs_) all_hold = all_hold && is_confirmed(limb.state());
  if (all_hold) {
    // Position loops bear what the feed-forward lets go. Now legs give way: only the dock keeps the
    // body up where it is.
    if (has_sagged()) {
      take(E::kHold);
      return;
    }
    for (LimbCycle& limb : limbs_) limb.give_way();
    if (in_state_s_ < params_.torque_ramp_s + params_.climb.motion.settle_s) return;
  }
  // Legs that stick hold a body without sagging: then the torques tell that no dock is there.
  if (are_claws_loaded(input)) {
    take(E::kHold);
    return;
  }
  for (const Leg leg : kLegs) {
    LimbCycle& limb = limbs_[leg];
    if (!is_confirmed(limb.state())) continue;
    is_stuck_ = limb.returned() && parked_ == leg;  // it was told to open, and holds again
    if (!is_stuck_ && limb.park()) parked_ = leg;
    return;
  }
  parking_ = false;
  hangs_ = false;  // all claws are open: the dock has it
}

bool Controller::has_sagged() const {
  const Eigen::Vector3d moved_m =
      odometry_.estimate().position_odom_m - T_odom_body_before_.translation();
  return !(moved_m.norm() <= params_.max_sag_m);
}

bool Controller::are_claws_loaded(const ControllerInput& input) const {
  const Eigen::Vector3d up = input.imu.q_odom_body.conjugate() * Eigen::Vector3d::UnitZ();
  double borne_N = 0.0;
  for (const Leg leg : kLegs) {
    if (!is_confirmed(limbs_[leg].state())) continue;
    const LimbInput limb = limb_input(input, leg);
    // tau = -J^T f of the rung on the foot.
    const Eigen::Matrix3d J = kinematics_.jacobian(leg, limb.angles_rad);
    borne_N -= up.dot(J.transpose().inverse() * limb.torques_Nm);
  }
  const double weight_N =
      params_.climb.support.gravity_m_s2 * MassModel(params_.climb.robot).total_kg();
  return !(borne_N <= params_.max_borne_part * weight_N);
}

}  // namespace climb
