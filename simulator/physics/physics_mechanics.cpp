// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/physics/physics_mechanics.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"

namespace simulator {
namespace {

using RowMatrix3d = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

constexpr double kLegBrake_Nm = 60.0;
constexpr double kJawBrake_Nm = 10.0;
/// Contacts come and go for single steps while a claw settles.
constexpr std::int64_t kContactMemory_us = 50'000;
constexpr double kEnclosing_rad = 0.5;  ///< a jaw more open than this does not enclose a rung
/// So long with less than two claws on a rung, out of the dock: it is falling.
constexpr std::int64_t kFall_us = 200'000;
constexpr double kFallSpeed_m_s = 1.5;

}  // namespace

PhysicsMechanics::PhysicsMechanics(const PlantParams& params, PhysicsModel& model)
    : params_(params), model_(model) {
  const auto step_us = std::llround(1e6 * model.model().opt.timestep);
  CHECK(step_us == Drive::kStep_us, "drives and physics step together");
  load_N_.assign(params.rungs.size(), 0.0);
  touched_.assign(params.rungs.size(), 0);
  place(params);
}

void PhysicsMechanics::place(const PlantParams& params) {
  mjData& state = model_.state();
  mj_resetData(&model_.model(), &state);
  const Eigen::Isometry3d pose = starting_pose(params);
  Eigen::Map<Eigen::Vector3d>(state.qpos) = pose.translation();
  const Eigen::Quaterniond rotation(pose.linear());
  state.qpos[3] = rotation.w();
  Eigen::Map<Eigen::Vector3d>(state.qpos + 4) = rotation.vec();
  for (int axis = 0; axis < kNumAxes; ++axis) {
    const PhysicsModel::Joint& joint = model_.joint(axis);
    state.qpos[joint.position] = params.drives[static_cast<std::size_t>(axis)].start_rad;
    frictionloss_Nm_[static_cast<std::size_t>(axis)] =
        model_.model().dof_frictionloss[joint.velocity];
  }
  mj_forward(&model_.model(), &state);
  tell_body();
  set_docked(params.start == PlantStart::kDocked);
}

void PhysicsMechanics::set_docked(bool docked) {
  mjModel& model = model_.model();
  mjData& state = model_.state();
  docked_ = docked;
  model.eq_active[model_.dock()] = docked ? 1 : 0;
  if (!docked) return;
  // A weld of the torso to the world where it is now. MuJoCo 2.2.2: [0..2] anchor in the world,
  // [3..5] the same point in the torso, [6..9] the world's attitude in the torso, [10] torque
  // scale.
  mjtNum* weld = model.eq_data + mjNEQDATA * model_.dock();
  std::fill(weld, weld + mjNEQDATA, 0.0);
  mjtNum inverse[4];
  mjtNum anchor[3];
  mju_negQuat(inverse, state.xquat + 4 * model_.torso_body());
  mju_rotVecQuat(anchor, state.xpos + 3 * model_.torso_body(), inverse);
  for (int i = 0; i < 3; ++i) weld[3 + i] = -anchor[i];
  for (int i = 0; i < 4; ++i) weld[6 + i] = inverse[i];
  weld[10] = 1.0;
}

void PhysicsMechanics::take_over(std::span<Drive> drives) {
  for (Drive& drive : drives) drive.motor().move_outside();
  observe(drives);
}

void PhysicsMechanics::step(std::int64_t now_us, std::span<Drive> drives, RungWorld& world) {
  now_us_ = now_us;
  command(drives);
  mj_step(&model_.model(), &model_.state());
  observe(drives);
  sum_contact_forces();
  tell_body();
  for (int leg = 0; leg < kNumLegs; ++leg) tell_leg(leg, drives, world);
  break_rungs(world);
  judge_fall();
}

void PhysicsMechanics::command(std::span<const Drive> drives) {
  mjModel& model = model_.model();
  for (int axis = 0; axis < kNumAxes; ++axis) {
    const PhysicsModel::Joint& joint = model_.joint(axis);
    const MotorCommand& command = drives[static_cast<std::size_t>(axis)].motor().command();
    const bool follows = command.kind == MotorCommand::Kind::kFollow;
    const double limit_Nm = follows ? command.torque_limit_Nm : 0.0;
    model.actuator_forcerange[2 * joint.actuator] = -limit_Nm;
    model.actuator_forcerange[2 * joint.actuator + 1] = limit_Nm;
    const double stiffness = model.actuator_gainprm[mjNGAIN * joint.actuator];
    const double damping = -model.actuator_biasprm[mjNBIAS * joint.actuator + 2];
    model_.state().ctrl[joint.actuator] =
        command.target_rad + (damping * command.velocity_rad_s + command.torque_Nm) / stiffness;
    const double brake_Nm = is_jaw(axis) ? kJawBrake_Nm : kLegBrake_Nm;
    model.dof_frictionloss[joint.velocity] = command.kind == MotorCommand::Kind::kBrake
                                                 ? brake_Nm
                                                 : frictionloss_Nm_[static_cast<std::size_t>(axis)];
  }
}

void PhysicsMechanics::observe(std::span<Drive> drives) const {
  const mjData& state = model_.state();
  for (int axis = 0; axis < kNumAxes; ++axis) {
    const PhysicsModel::Joint& joint = model_.joint(axis);
    drives[static_cast<std::size_t>(axis)].motor().observe({state.qpos[joint.position],
                                                            state.qvel[joint.velocity],
                                                            state.actuator_force[joint.actuator]});
  }
}

void PhysicsMechanics::sum_contact_forces() {
  for (Hold& hold : holds_) {
    hold.force_on_rung_N.setZero();
    hold.strongest_N = 0.0;
  }
  const mjData& state = model_.state();
  for (int i = 0; i < state.ncon; ++i) {
    const mjContact& contact = state.contact[i];
    const int leg1 = model_.leg_of_claw_geom(contact.geom1);
    const int leg2 = model_.leg_of_claw_geom(contact.geom2);
    const int leg = std::max(leg1, leg2);
    const int rung =
        std::max(model_.rung_of_geom(contact.geom1), model_.rung_of_geom(contact.geom2));
    if (leg < 0 || rung < 0) continue;
    mjtNum wrench[6];
    mj_contactForce(&model_.model(), &state, i, wrench);
    // In the contact's frame, whose rows are its axes, and on the second geom.
    const Eigen::Vector3d force_N = Eigen::Map<const RowMatrix3d>(contact.frame).transpose() *
                                    Eigen::Map<const Eigen::Vector3d>(wrench);
    Hold& hold = holds_[static_cast<std::size_t>(leg)];
    hold.force_on_rung_N += leg1 >= 0 ? force_N : Eigen::Vector3d(-force_N);
    hold.contact_us = now_us_;
    if (force_N.norm() < hold.strongest_N) continue;
    hold.strongest_N = force_N.norm();
    hold.rung = rung;
  }
}

void PhysicsMechanics::tell_leg(int leg, std::span<const Drive> drives, const RungWorld& world) {
  const auto index = static_cast<std::size_t>(leg);
  Hold& hold = holds_[index];
  LegTruth& told = legs_[index];
  const Drive& jaw = drives[static_cast<std::size_t>(axis_of(leg, 3))];
  const bool encloses = jaw.measured_rad() < kEnclosing_rad;
  const bool touches = hold.contact_us >= 0 && now_us_ - hold.contact_us <= kContactMemory_us;
  const bool had = told.holds;
  told.holds = encloses && touches && hold.rung >= 0 && !world.rung(hold.rung).broken;
  if (had && !told.holds) {
    told.lost_us = now_us_;
    told.last_loss = hold.rung >= 0 && world.rung(hold.rung).broken ? LossCause::kRungBroke
                     : encloses                                     ? LossCause::kTornOff
                                                                    : LossCause::kOpened;
  }
  told.rung_index = told.holds ? hold.rung : -1;
  told.bears = told.holds;
  for (int joint = 0; joint < kJointsPerLeg; ++joint) {
    told.bears =
        told.bears && drives[static_cast<std::size_t>(axis_of(leg, joint))].holds_position();
  }
  told.p_world_foot_m =
      Eigen::Map<const Eigen::Vector3d>(model_.state().site_xpos + 3 * model_.foot_site(leg));
  told.force_on_rung_N = hold.force_on_rung_N;
  // Without torque a brake keeps what the jaw pressed.
  const bool powered = has_torque(jaw.power_state());
  const bool presses = powered ? std::fabs(jaw.motor().torque_Nm()) > params_.claw.touch_torque_Nm
                               : hold.pressed_us >= 0;
  const bool pressed = told.holds && presses;
  if (!pressed) hold.pressed_us = -1;
  if (pressed && hold.pressed_us < 0) hold.pressed_us = now_us_;
  told.touch = pressed && now_us_ - hold.pressed_us >= params_.claw.touch_us;
}

void PhysicsMechanics::tell_body() {
  const mjData& state = model_.state();
  const int torso = model_.torso_body();
  body_.T_world_body.translation() = Eigen::Map<const Eigen::Vector3d>(state.xpos + 3 * torso);
  body_.T_world_body.linear() = Eigen::Map<const RowMatrix3d>(state.xmat + 9 * torso);
  // The order of the sensors in robot.xml: accelerometer, gyroscope.
  body_.specific_force_m_s2 = Eigen::Map<const Eigen::Vector3d>(state.sensordata);
  body_.angular_rate_rad_s = Eigen::Map<const Eigen::Vector3d>(state.sensordata + 3);
}

void PhysicsMechanics::break_rungs(RungWorld& world) {
  std::fill(load_N_.begin(), load_N_.end(), 0.0);
  std::fill(touched_.begin(), touched_.end(), 0);
  for (int leg = 0; leg < kNumLegs; ++leg) {
    const LegTruth& told = legs_[static_cast<std::size_t>(leg)];
    if (!told.holds) continue;
    load_N_[static_cast<std::size_t>(told.rung_index)] += told.force_on_rung_N.norm();
    touched_[static_cast<std::size_t>(told.rung_index)] = 1;
  }
  world.update(now_us_, load_N_, touched_);
  for (int rung = 0; rung < world.num_rungs(); ++rung) {
    if (world.rung(rung).broken) model_.remove_rung(rung);
  }
}

void PhysicsMechanics::judge_fall() {
  int num_holding = 0;
  for (const LegTruth& leg : legs_) num_holding += leg.holds ? 1 : 0;
  const bool unheld = !docked_ && num_holding < 2;
  if (!unheld) unheld_us_ = -1;
  if (unheld && unheld_us_ < 0) unheld_us_ = now_us_;
  if (unheld && now_us_ - unheld_us_ >= kFall_us) fallen_ = true;
  if (model_.state().qvel[2] < -kFallSpeed_m_s) fallen_ = true;
}

}  // namespace simulator
