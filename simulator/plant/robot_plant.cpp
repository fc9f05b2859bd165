// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/plant/robot_plant.h"

#include <algorithm>

#include "base/check.h"
#include "simulator/plant/quasi_static.h"

namespace simulator {
namespace {

/// The parameters with the legs at their starting angles, once they are known to be sound.
PlantParams checked(const PlantParams& params) {
  const std::string problem = check(params);
  CHECK(problem.empty(), problem.c_str());
  PlantParams placed = params;
  place_legs(placed);
  return placed;
}

}  // namespace

RobotPlant::RobotPlant(const PlantParams& params, MemoryBus& bus)
    : RobotPlant(params, bus, make_quasi_static) {}

RobotPlant::RobotPlant(const PlantParams& params, MemoryBus& bus, const MakeMechanics& make)
    : params_(checked(params)),
      bus_(bus),
      world_(params.rungs),
      mechanics_(make(params_)),
      noise_(params.seed) {
  for (const DriveParams& drive : params_.drives) {
    drives_.emplace_back(drive);
    drive_ports_.push_back(bus_.attach(drive.node_id));
  }
  mechanics_->take_over(drives_);
  for (int leg = 0; params.has_force_nodes && leg < kNumLegs; ++leg) {
    const auto node_id = static_cast<std::uint8_t>(0x21 + leg);
    force_nodes_.emplace_back(node_id);
    force_ports_.push_back(bus_.attach(node_id));
  }
}

void RobotPlant::advance(std::int64_t now_us) {
  for (; next_step_us_ <= now_us; next_step_us_ += Drive::kStep_us) {
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
  mechanics_->step(now_us, drives_, world_);
}

void RobotPlant::step_nodes(std::int64_t now_us) {
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    drives_[i].advance(now_us, sent_);
    flush(drive_ports_[i], now_us);
  }
  for (std::size_t i = 0; i < force_nodes_.size(); ++i) {
    const LegTruth& leg = mechanics_->leg(static_cast<int>(i));
    force_nodes_[i].touch = leg.touch;
    force_nodes_[i].across_N = -leg.force_on_rung_N.x();
    force_nodes_[i].down_N = -leg.force_on_rung_N.z();
    force_nodes_[i].advance(now_us, sent_);
    flush(force_ports_[i], now_us);
  }
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
  for (int leg = 0; leg < kNumLegs; ++leg) {
    levels[static_cast<std::size_t>(leg)] = mechanics_->leg(leg).touch;
  }
  levels[kEstopN] = !estop_pressed_;
  for (std::size_t i = 0; i < levels.size(); ++i) levels[i] = level_on_wire(levels[i], wires_[i]);
  return levels;
}

}  // namespace simulator
