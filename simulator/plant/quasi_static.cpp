// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/plant/quasi_static.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "simulator/plant/body_pose.h"

namespace simulator {
namespace {

constexpr std::int64_t kStep_us = Drive::kStep_us;
constexpr double kStep_s = 1e-6 * static_cast<double>(kStep_us);
constexpr double kGravity_m_s2 = 9.81;
constexpr double kBend_s = 0.010;  ///< time in which a joint bends or springs back
constexpr double kMaxBend_rad = 0.25;
constexpr double kFloorHeight_m = 0.15;  ///< a fallen body lies there
constexpr std::int64_t kWeighing_us = 10'000;

bool is_in(unsigned legs, int leg) {
  return (legs >> leg & 1U) != 0;
}

template <class DriveType>
DriveType& joint_of_leg(std::span<DriveType> drives, int leg, int joint) {
  return drives[static_cast<std::size_t>(axis_of(leg, joint))];
}

LegAngles leg_angles(int leg, std::span<const Drive> drives, bool deflected) {
  LegAngles angles;
  for (int joint = 0; joint < 3; ++joint) {
    const Drive& drive = joint_of_leg(drives, leg, joint);
    angles[joint] = deflected ? drive.measured_rad() : drive.motor().position_rad();
  }
  return angles;
}

}  // namespace

QuasiStatic::QuasiStatic(const PlantParams& params) : params_(params) {
  body_.T_world_body = starting_pose(params);
  T_world_dock_ = body_.T_world_body;
  docked_ = params.start == PlantStart::kDocked;
  force_on_rung_N_.fill(Eigen::Vector3d::Zero());
  weight_share_N_.fill(Eigen::Vector3d::Zero());
  for (int leg = 0; leg < kNumLegs; ++leg) claws_.emplace_back(params.claw);
}

std::unique_ptr<Mechanics> make_quasi_static(const PlantParams& params) {
  return std::make_unique<QuasiStatic>(params);
}

void QuasiStatic::set_docked(bool docked) {
  if (docked && !docked_) T_world_dock_ = body_.T_world_body;
  docked_ = docked;
  weighed_legs_ = ~0U;
}

void QuasiStatic::step(std::int64_t now_us, std::span<Drive> drives, RungWorld& world) {
  now_us_ = now_us;
  step_claws(drives, world);
  if (fallen_) {
    fall();
  } else {
    step_body(drives);
    step_loads(drives);
    step_rungs(world);
    const auto num_bearing = std::count(bearing_.begin(), bearing_.end(), true);
    if (!docked_ && num_bearing < 2) fallen_ = true;
  }
  tell(drives);
}

void QuasiStatic::step_claws(std::span<Drive> drives, const RungWorld& world) {
  for (int leg = 0; leg < kNumLegs; ++leg) {
    Drive& jaw = joint_of_leg(drives, leg, 3);
    Claw& claw = claws_[static_cast<std::size_t>(leg)];
    ClawInputs inputs;
    inputs.now_us = now_us_;
    inputs.p_world_foot_m =
        body_.T_world_body * foot_in_body(params_.geometry, leg, leg_angles(leg, drives, true));
    inputs.jaw_rad = jaw.measured_rad();
    inputs.jaw_torque_Nm = jaw.motor().torque_Nm();
    inputs.jaw_powered = has_torque(jaw.power_state());
    inputs.force_N = force_on_rung_N_[static_cast<std::size_t>(leg)].norm();
    claw.update(inputs, world);
    jaw.motor().set_lower_stop(claw.jaw_stop_rad());
    // The rung presses the jaw open, at most as hard as the jaw may press.
    const double press_Nm = std::min(claw.press_Nm(jaw.demand_rad()), jaw.torque_limit_Nm());
    jaw.motor().set_load(-std::min(
        press_Nm, params_.drives[static_cast<std::size_t>(axis_of(leg, 3))].motor.peak_torque_Nm));
  }
}

bool QuasiStatic::bears(int leg, std::span<const Drive> drives) const {
  if (!claws_[static_cast<std::size_t>(leg)].holds()) return false;
  for (int joint = 0; joint < kJointsPerLeg; ++joint) {
    if (!joint_of_leg(drives, leg, joint).holds_position()) return false;
  }
  return true;
}

void QuasiStatic::step_body(std::span<const Drive> drives) {
  std::array<Support, 2 * kNumLegs> supports;
  std::size_t num = 0;
  for (int leg = 0; leg < kNumLegs; ++leg) {
    if (bears(leg, drives)) {
      supports[num++] = {foot_in_body(params_.geometry, leg, leg_angles(leg, drives, false)),
                         claws_[static_cast<std::size_t>(leg)].anchor_m(),
                         params_.foot_stiffness_N_m};
    }
    if (docked_) {
      const Eigen::Vector3d hip(forward_sign(leg) * params_.geometry.hip_x_m,
                                left_sign(leg) * params_.geometry.hip_y_m, 0.0);
      supports[num++] = {hip, T_world_dock_ * hip, params_.dock_stiffness_N_m};
    }
  }
  const Eigen::Isometry3d before = body_.T_world_body;
  body_.T_world_body = balanced_pose({supports.data(), num}, before);
  const Eigen::Matrix3d turned = before.linear().transpose() * body_.T_world_body.linear();
  body_.angular_rate_rad_s =
      Eigen::Vector3d(turned(2, 1) - turned(1, 2), turned(0, 2) - turned(2, 0),
                      turned(1, 0) - turned(0, 1)) /
      (2.0 * kStep_s);
}

void QuasiStatic::weigh(unsigned bearing) {
  if (bearing == weighed_legs_ && now_us_ - weighed_us_ < kWeighing_us) return;
  weighed_legs_ = bearing;
  weighed_us_ = now_us_;
  std::vector<Eigen::Vector3d> contacts;
  for (int leg = 0; leg < kNumLegs; ++leg) {
    if (is_in(bearing, leg)) contacts.push_back(claws_[static_cast<std::size_t>(leg)].anchor_m());
  }
  const double weight_N = docked_ ? 0.0 : params_.weight_N;
  const auto shares = weight_shares(contacts, body_.T_world_body.translation(), weight_N);
  std::size_t next = 0;
  for (int leg = 0; leg < kNumLegs; ++leg) {
    Eigen::Vector3d& share = weight_share_N_[static_cast<std::size_t>(leg)];
    share.setZero();
    if (is_in(bearing, leg)) share = -shares[next++];
  }
}

void QuasiStatic::step_loads(std::span<Drive> drives) {
  unsigned bearing = 0;
  for (int leg = 0; leg < kNumLegs; ++leg) {
    bearing_[static_cast<std::size_t>(leg)] = bears(leg, drives);
    if (bearing_[static_cast<std::size_t>(leg)]) bearing |= 1U << leg;
  }
  weigh(bearing);
  for (int leg = 0; leg < kNumLegs; ++leg) load_leg(leg, drives);
}

void QuasiStatic::load_leg(int leg, std::span<Drive> drives) {
  const LegAngles angles = leg_angles(leg, drives, false);
  const Eigen::Matrix3d jacobian = foot_jacobian(params_.geometry, leg, angles);
  Eigen::Vector3d bend = Eigen::Vector3d::Zero();
  Eigen::Vector3d& force_N = force_on_rung_N_[static_cast<std::size_t>(leg)];
  force_N.setZero();
  if (bearing_[static_cast<std::size_t>(leg)]) {
    const Eigen::Vector3d foot = foot_in_body(params_.geometry, leg, angles);
    const Eigen::Vector3d anchor =
        body_.T_world_body.inverse() * claws_[static_cast<std::size_t>(leg)].anchor_m();
    force_N = params_.foot_stiffness_N_m * (body_.T_world_body.linear() * (foot - anchor)) +
              weight_share_N_[static_cast<std::size_t>(leg)];
    // The joints bend until the foot is on its contact: the encoders read what geometry allows.
    const Eigen::Matrix3d damped =
        jacobian.transpose() * jacobian + 1e-6 * Eigen::Matrix3d::Identity();
    bend = damped.inverse() * (jacobian.transpose() * (anchor - foot));
  }
  const Eigen::Vector3d torque_Nm =
      jacobian.transpose() * (body_.T_world_body.linear().transpose() * force_N);
  for (int joint = 0; joint < 3; ++joint) {
    Drive& joint_drive = joint_of_leg(drives, leg, joint);
    joint_drive.motor().set_load(torque_Nm[joint]);
    const double now_rad = joint_drive.measured_rad() - joint_drive.motor().position_rad();
    const double wanted_rad = std::clamp(bend[joint], -kMaxBend_rad, kMaxBend_rad);
    joint_drive.set_deflection(now_rad + (wanted_rad - now_rad) * (kStep_s / kBend_s));
  }
}

void QuasiStatic::step_rungs(RungWorld& world) const {
  std::vector<double> load_N(static_cast<std::size_t>(world.num_rungs()), 0.0);
  std::vector<char> touched(load_N.size(), 0);
  for (int leg = 0; leg < kNumLegs; ++leg) {
    const Claw& claw = claws_[static_cast<std::size_t>(leg)];
    if (!claw.holds()) continue;
    const auto rung = static_cast<std::size_t>(claw.rung_index());
    load_N[rung] += force_on_rung_N_[static_cast<std::size_t>(leg)].norm();
    touched[rung] = 1;
  }
  world.update(now_us_, load_N, touched);
}

void QuasiStatic::fall() {
  Eigen::Vector3d position = body_.T_world_body.translation();
  fall_m_s_ = position.z() > kFloorHeight_m ? fall_m_s_ + kGravity_m_s2 * kStep_s : 0.0;
  position.z() = std::max(kFloorHeight_m, position.z() - fall_m_s_ * kStep_s);
  body_.T_world_body.translation() = position;
  body_.angular_rate_rad_s.setZero();
  force_on_rung_N_.fill(Eigen::Vector3d::Zero());
}

void QuasiStatic::tell(std::span<const Drive> drives) {
  const bool falls = fallen_ && fall_m_s_ > 0.0;
  body_.specific_force_m_s2.setZero();
  if (!falls) {
    body_.specific_force_m_s2 =
        body_.T_world_body.linear().transpose() * Eigen::Vector3d(0.0, 0.0, kGravity_m_s2);
  }
  for (int leg = 0; leg < kNumLegs; ++leg) {
    const Claw& claw = claws_[static_cast<std::size_t>(leg)];
    LegTruth& told = legs_[static_cast<std::size_t>(leg)];
    told.holds = claw.holds();
    told.bears = bears(leg, drives);
    told.touch = claw.touch();
    told.rung_index = claw.holds() ? claw.rung_index() : -1;
    told.p_world_foot_m =
        body_.T_world_body * foot_in_body(params_.geometry, leg, leg_angles(leg, drives, true));
    told.force_on_rung_N = force_on_rung_N_[static_cast<std::size_t>(leg)];
    told.last_loss = claw.last_loss();
    told.lost_us = claw.lost_us();
  }
}

}  // namespace simulator
