// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/plant/robot_plant.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "base/check.h"

namespace simulator {
namespace {

constexpr std::int64_t kStep_us = Drive::kStep_us;
constexpr double kStep_s = 1e-6 * static_cast<double>(kStep_us);
constexpr double kGravity_m_s2 = 9.81;
constexpr double kBend_s = 0.010;  ///< time in which a joint bends or springs back
constexpr double kMaxBend_rad = 0.25;
constexpr double kFloorHeight_m = 0.15;  ///< a fallen body lies there
constexpr std::int64_t kWeighing_us = 10'000;

/// Body x up the ladder, z away from it.
Eigen::Matrix3d upright() {
  Eigen::Matrix3d rotation;
  rotation << 0, 0, -1, 0, 1, 0, 1, 0, 0;
  return rotation;
}

bool is_in(unsigned legs, int leg) {
  return (legs >> leg & 1U) != 0;
}

}  // namespace

RobotPlant::RobotPlant(const PlantParams& params, MemoryBus& bus)
    : params_(params), bus_(bus), world_(params.rungs), noise_(params.seed) {
  const std::string problem = check(params);
  CHECK(problem.empty(), problem.c_str());
  T_world_body_.linear() = upright();
  T_world_body_.translation() = Eigen::Vector3d(-params.stand_off_m, 0.0, params.body_height_m);
  T_world_dock_ = T_world_body_;
  docked_ = params.start == PlantStart::kDocked;
  force_on_rung_N_.fill(Eigen::Vector3d::Zero());
  weight_share_N_.fill(Eigen::Vector3d::Zero());
  for (int leg = 0; leg < kNumLegs; ++leg) claws_.emplace_back(params.claw);
  place_legs();
  for (const DriveParams& drive : params_.drives) {
    drives_.emplace_back(drive);
    drive_ports_.push_back(bus_.attach(drive.node_id));
  }
  for (int leg = 0; params.has_force_nodes && leg < kNumLegs; ++leg) {
    const auto node_id = static_cast<std::uint8_t>(0x21 + leg);
    force_nodes_.emplace_back(node_id);
    force_ports_.push_back(bus_.attach(node_id));
  }
}

void RobotPlant::place_legs() {
  const bool gripping = params_.start == PlantStart::kGripping;
  for (int leg = 0; leg < kNumLegs; ++leg) {
    const LadderRung& rung = world_.rung(params_.start_rung[static_cast<std::size_t>(leg)]);
    Eigen::Vector3d foot_world = 0.5 * (rung.end0_m + rung.end1_m);
    foot_world.y() = left_sign(leg) * params_.foot_y_m;
    if (!gripping) foot_world.x() -= params_.docked_gap_m;
    const auto angles =
        angles_for_foot(params_.geometry, leg, T_world_body_.inverse() * foot_world);
    CHECK(angles.has_value(), "the starting rungs must be within reach of the legs");
    for (int joint = 0; joint < 3; ++joint) {
      params_.drives[static_cast<std::size_t>(axis_of(leg, joint))].start_rad = (*angles)[joint];
    }
    const Claw& claw = claws_[static_cast<std::size_t>(leg)];
    params_.drives[static_cast<std::size_t>(axis_of(leg, 3))].start_rad =
        gripping ? claw.contact_rad(rung.radius_m) : params_.claw.open_rad;
  }
}

void RobotPlant::advance(std::int64_t now_us) {
  for (; next_step_us_ <= now_us; next_step_us_ += kStep_us) {
    hear_until(next_step_us_);
    step(next_step_us_);
  }
  hear_until(now_us);
  now_us_ = std::max(now_us_, now_us);
}

void RobotPlant::flush(int port, std::int64_t now_us) {
  // What a node cannot send on a bus that is down or full is lost.
  for (const BusFrame& frame : sent_) bus_.send(port, frame, now_us);
  sent_.clear();
}

void RobotPlant::hear_until(std::int64_t until_us) {
  CarriedFrame heard;
  while (true) {
    std::size_t earliest = drive_ports_.size() + force_ports_.size();
    std::int64_t due_us = until_us + 1;
    for (std::size_t i = 0; i < drive_ports_.size() + force_ports_.size(); ++i) {
      const int port =
          i < drive_ports_.size() ? drive_ports_[i] : force_ports_[i - drive_ports_.size()];
      const std::int64_t port_due_us = bus_.next_due_us(port);
      if (port_due_us >= due_us) continue;
      due_us = port_due_us;
      earliest = i;
    }
    if (due_us > until_us) return;
    if (earliest < drive_ports_.size()) {
      bus_.receive(drive_ports_[earliest], until_us, heard);
      drives_[earliest].receive(heard.frame, heard.time_us, sent_);
      flush(drive_ports_[earliest], heard.time_us);
    } else {
      const std::size_t node = earliest - drive_ports_.size();
      bus_.receive(force_ports_[node], until_us, heard);
      force_nodes_[node].receive(heard.frame, sent_);
      flush(force_ports_[node], heard.time_us);
    }
  }
}

void RobotPlant::step(std::int64_t now_us) {
  now_us_ = now_us;
  cut_torque_by_estop();
  step_nodes(now_us);
  step_claws();
  if (fallen_) return fall();
  step_body();
  step_loads();
  step_rungs();
  if (!docked_ && num_bearing() < 2) fallen_ = true;
}

void RobotPlant::step_nodes(std::int64_t now_us) {
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    drives_[i].advance(now_us, sent_);
    flush(drive_ports_[i], now_us);
  }
  for (std::size_t i = 0; i < force_nodes_.size(); ++i) {
    force_nodes_[i].touch = claws_[i].touch();
    force_nodes_[i].across_N = -force_on_rung_N_[i].x();
    force_nodes_[i].down_N = -force_on_rung_N_[i].z();
    force_nodes_[i].advance(now_us, sent_);
    flush(force_ports_[i], now_us);
  }
}

LegAngles RobotPlant::leg_angles(int leg, bool deflected) const {
  LegAngles angles;
  for (int joint = 0; joint < 3; ++joint) {
    const Drive& joint_drive = drive(axis_of(leg, joint));
    angles[joint] = deflected ? joint_drive.measured_rad() : joint_drive.motor().position_rad();
  }
  return angles;
}

void RobotPlant::step_claws() {
  for (int leg = 0; leg < kNumLegs; ++leg) {
    Drive& jaw = drive(axis_of(leg, 3));
    Claw& claw = claws_[static_cast<std::size_t>(leg)];
    ClawInputs inputs;
    inputs.now_us = now_us_;
    inputs.p_world_foot_m =
        T_world_body_ * foot_in_body(params_.geometry, leg, leg_angles(leg, true));
    inputs.jaw_rad = jaw.measured_rad();
    inputs.jaw_torque_Nm = jaw.motor().torque_Nm();
    inputs.jaw_powered = has_torque(jaw.power_state());
    inputs.force_N = force_on_rung_N_[static_cast<std::size_t>(leg)].norm();
    claw.update(inputs, world_);
    jaw.motor().set_lower_stop(claw.jaw_stop_rad());
    // The rung presses the jaw open, at most as hard as the jaw may press.
    const double press_Nm = std::min(claw.press_Nm(jaw.demand_rad()), jaw.torque_limit_Nm());
    jaw.motor().set_load(-std::min(
        press_Nm, params_.drives[static_cast<std::size_t>(axis_of(leg, 3))].motor.peak_torque_Nm));
  }
}

bool RobotPlant::bears(int leg) const {
  if (!claws_[static_cast<std::size_t>(leg)].holds()) return false;
  for (int joint = 0; joint < kJointsPerLeg; ++joint) {
    if (!drive(axis_of(leg, joint)).holds_position()) return false;
  }
  return true;
}

int RobotPlant::num_bearing() const {
  int num = 0;
  for (int leg = 0; leg < kNumLegs; ++leg) num += bears(leg) ? 1 : 0;
  return num;
}

void RobotPlant::step_body() {
  std::array<Support, 2 * kNumLegs> supports;
  std::size_t num = 0;
  for (int leg = 0; leg < kNumLegs; ++leg) {
    if (bears(leg)) {
      supports[num++] = {foot_in_body(params_.geometry, leg, leg_angles(leg, false)),
                         claws_[static_cast<std::size_t>(leg)].anchor_m(),
                         params_.foot_stiffness_N_m};
    }
    if (docked_) {
      const Eigen::Vector3d hip(forward_sign(leg) * params_.geometry.hip_x_m,
                                left_sign(leg) * params_.geometry.hip_y_m, 0.0);
      supports[num++] = {hip, T_world_dock_ * hip, params_.dock_stiffness_N_m};
    }
  }
  const Eigen::Isometry3d before = T_world_body_;
  T_world_body_ = balanced_pose({supports.data(), num}, before);
  const Eigen::Matrix3d turned = before.linear().transpose() * T_world_body_.linear();
  angular_rate_rad_s_ = Eigen::Vector3d(turned(2, 1) - turned(1, 2), turned(0, 2) - turned(2, 0),
                                        turned(1, 0) - turned(0, 1)) /
                        (2.0 * kStep_s);
}

void RobotPlant::weigh(unsigned bearing) {
  if (bearing == weighed_legs_ && now_us_ - weighed_us_ < kWeighing_us) return;
  weighed_legs_ = bearing;
  weighed_us_ = now_us_;
  std::vector<Eigen::Vector3d> contacts;
  for (int leg = 0; leg < kNumLegs; ++leg) {
    if (is_in(bearing, leg)) contacts.push_back(claws_[static_cast<std::size_t>(leg)].anchor_m());
  }
  const double weight_N = docked_ ? 0.0 : params_.weight_N;
  const auto shares = weight_shares(contacts, T_world_body_.translation(), weight_N);
  std::size_t next = 0;
  for (int leg = 0; leg < kNumLegs; ++leg) {
    Eigen::Vector3d& share = weight_share_N_[static_cast<std::size_t>(leg)];
    share.setZero();
    if (is_in(bearing, leg)) share = -shares[next++];
  }
}

void RobotPlant::step_loads() {
  unsigned bearing = 0;
  for (int leg = 0; leg < kNumLegs; ++leg) {
    if (bears(leg)) bearing |= 1U << leg;
  }
  weigh(bearing);
  for (int leg = 0; leg < kNumLegs; ++leg) load_leg(leg, is_in(bearing, leg));
}

void RobotPlant::load_leg(int leg, bool bearing) {
  const LegAngles angles = leg_angles(leg, false);
  const Eigen::Matrix3d jacobian = foot_jacobian(params_.geometry, leg, angles);
  Eigen::Vector3d bend = Eigen::Vector3d::Zero();
  Eigen::Vector3d& force_N = force_on_rung_N_[static_cast<std::size_t>(leg)];
  force_N.setZero();
  if (bearing) {
    const Eigen::Vector3d foot = foot_in_body(params_.geometry, leg, angles);
    const Eigen::Vector3d anchor =
        T_world_body_.inverse() * claws_[static_cast<std::size_t>(leg)].anchor_m();
    force_N = params_.foot_stiffness_N_m * (T_world_body_.linear() * (foot - anchor)) +
              weight_share_N_[static_cast<std::size_t>(leg)];
    // The joints bend until the foot is on its contact: the encoders read what geometry allows.
    const Eigen::Matrix3d damped =
        jacobian.transpose() * jacobian + 1e-6 * Eigen::Matrix3d::Identity();
    bend = damped.inverse() * (jacobian.transpose() * (anchor - foot));
  }
  const Eigen::Vector3d torque_Nm =
      jacobian.transpose() * (T_world_body_.linear().transpose() * force_N);
  for (int joint = 0; joint < 3; ++joint) {
    Drive& joint_drive = drive(axis_of(leg, joint));
    joint_drive.motor().set_load(torque_Nm[joint]);
    const double now_rad = joint_drive.measured_rad() - joint_drive.motor().position_rad();
    const double wanted_rad = std::clamp(bend[joint], -kMaxBend_rad, kMaxBend_rad);
    joint_drive.set_deflection(now_rad + (wanted_rad - now_rad) * (kStep_s / kBend_s));
  }
}

void RobotPlant::step_rungs() {
  std::vector<double> load_N(static_cast<std::size_t>(world_.num_rungs()), 0.0);
  std::vector<char> touched(load_N.size(), 0);
  for (int leg = 0; leg < kNumLegs; ++leg) {
    const Claw& claw = claws_[static_cast<std::size_t>(leg)];
    if (!claw.holds()) continue;
    const auto rung = static_cast<std::size_t>(claw.rung_index());
    load_N[rung] += force_on_rung_N_[static_cast<std::size_t>(leg)].norm();
    touched[rung] = 1;
  }
  world_.update(now_us_, load_N, touched);
}

void RobotPlant::fall() {
  Eigen::Vector3d position = T_world_body_.translation();
  fall_m_s_ = position.z() > kFloorHeight_m ? fall_m_s_ + kGravity_m_s2 * kStep_s : 0.0;
  position.z() = std::max(kFloorHeight_m, position.z() - fall_m_s_ * kStep_s);
  T_world_body_.translation() = position;
  angular_rate_rad_s_.setZero();
  force_on_rung_N_.fill(Eigen::Vector3d::Zero());
}

void RobotPlant::cut_torque_by_estop() {
  const bool open = !lines()[kEstopN];
  if (!open) estop_since_us_ = -1;
  if (open && estop_since_us_ < 0) estop_since_us_ = now_us_;
  if (!params_.estop_cuts_torque_us) return;
  const bool cut = open && now_us_ - estop_since_us_ >= *params_.estop_cuts_torque_us;
  for (Drive& each : drives_) each.set_torque_permitted(!cut);
}

LineLevels RobotPlant::lines() const {
  LineLevels levels{};
  for (std::size_t leg = 0; leg < claws_.size(); ++leg) levels[leg] = claws_[leg].touch();
  levels[kEstopN] = !estop_pressed_;
  for (std::size_t i = 0; i < levels.size(); ++i) levels[i] = level_on_wire(levels[i], wires_[i]);
  return levels;
}

}  // namespace simulator
