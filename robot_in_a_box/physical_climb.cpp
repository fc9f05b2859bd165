// SPDX-License-Identifier: BSD-3-Clause
#include "robot_in_a_box/physical_climb.h"

#include "simulator/physics/before_ladder.h"

namespace robot_in_a_box {
namespace {

using climb::ControllerState;
using simulator::LimbPhase;

std::vector<int> unsafe_rungs(const simulator::Scene& scene) {
  std::vector<int> unsafe;
  for (std::size_t i = 0; i < scene.rungs.size(); ++i) {
    const bool is_sound = scene.rungs[i].kind == simulator::RungKind::kSound;
    if (!is_sound) unsafe.push_back(static_cast<int>(i));
  }
  return unsafe;
}

ClimbBoxParams box_params(const PhysicalClimbParams& params, const simulator::Scene& scene,
                          simulator::PhysicsModel& model) {
  ClimbBoxParams box;
  box.plant = simulator::before_ladder(scene);
  for (const WeakRung& weak : params.weak_rungs) {
    box.plant.rungs.at(static_cast<std::size_t>(weak.index)).break_load_N = weak.break_load_N;
  }
  box.perception = params.perception;
  box.cycle = params.cycle;
  box.seed = params.seed;
  box.attitude_from_samples = params.attitude_from_samples;
  box.mechanics = [&model](const simulator::PlantParams& plant) {
    return std::make_unique<simulator::PhysicsMechanics>(plant, model);
  };
  return box;
}

LimbPhase phase_of(climb::LimbState state) {
  switch (state) {
    case climb::LimbState::kLoaded:
      return LimbPhase::kHolds;
    case climb::LimbState::kClosing:
    case climb::LimbState::kVerify:
    case climb::LimbState::kLoading:
      return LimbPhase::kTries;
    default:
      return LimbPhase::kAway;
  }
}

}  // namespace

const char* name(ClimbEnd end) {
  switch (end) {
    case ClimbEnd::kTop:
      return "top";
    case ClimbEnd::kDock:
      return "dock";
    case ClimbEnd::kHeld:
      return "held";
    case ClimbEnd::kFault:
      return "fault";
    case ClimbEnd::kFallen:
      return "fallen";
    case ClimbEnd::kTooLong:
      return "too long";
  }
  return "?";
}

PhysicalClimb::PhysicalClimb(const PhysicalClimbParams& params)
    : scene_(simulator::make_scene(params.scene)),
      model_(scene_),
      box_(box_params(params, scene_, model_)),
      figures_(unsafe_rungs(scene_)) {
  for (const int rung : unsafe_rungs(scene_)) {
    box_.perception().damaged_rungs.push_back(rung);
  }
  box_.watch(this);
}

void PhysicalClimb::on_truth(const simulator::PlantTruth& truth) {
  simulator::ClimbMoment moment{truth.time_us, truth, {}, box_.T_odom_body()};
  for (const climb::Leg leg : climb::kLegs) {
    moment.limbs[leg] = phase_of(box_.report().output.limbs[leg]);
  }
  moment.climbs = box_.state() == ControllerState::kClimbing;
  figures_.see(moment);
}

bool PhysicalClimb::reach(ControllerState state, double within_s) {
  for (int i = 0; i < static_cast<int>(100.0 * within_s) && box_.state() != state; ++i) {
    box_.cycle();
  }
  return box_.state() == state;
}

void PhysicalClimb::run_s(double duration_s) {
  for (int i = 0; i < static_cast<int>(100.0 * duration_s); ++i) box_.cycle();
}

int PhysicalClimb::num_held() const {
  int num = 0;
  for (int leg = 0; leg < simulator::kNumLegs; ++leg) num += box_.plant().leg(leg).holds ? 1 : 0;
  return num;
}

bool PhysicalClimb::hang() {
  if (!reach(ControllerState::kDisarmed, 5.0)) return false;
  box_.order(climb::Order::kArm);
  if (!reach(ControllerState::kArming, 1.0) || !reach(ControllerState::kHold, 120.0)) return false;
  box_.plant().set_docked(false);
  run_s(2.0);
  return box_.state() == ControllerState::kHold && !box_.plant().truth().fallen;
}

ClimbEnd PhysicalClimb::climb(bool upwards, double within_s) {
  box_.order(upwards ? climb::Order::kClimb : climb::Order::kClimbDown);
  box_.cycle();
  for (int i = 0; i < static_cast<int>(100.0 * within_s); ++i) {
    box_.cycle();
    if (box_.plant().truth().fallen) return ClimbEnd::kFallen;
    if (climb::is_latched(box_.state())) {
      run_s(2.0);  // what a stop leads to counts too
      return box_.plant().truth().fallen ? ClimbEnd::kFallen : ClimbEnd::kFault;
    }
    if (box_.state() != ControllerState::kHold) continue;
    if (box_.report().output.at_top && upwards) return ClimbEnd::kTop;
    return box_.report().output.at_dock && !upwards ? ClimbEnd::kDock : ClimbEnd::kHeld;
  }
  return ClimbEnd::kTooLong;
}

bool PhysicalClimb::back_into_dock() {
  box_.plant().set_docked(true);
  run_s(0.5);
  box_.order(climb::Order::kDisarm);
  return reach(ControllerState::kDisarming, 0.1) && reach(ControllerState::kDisarmed, 60.0);
}

std::string PhysicalClimb::reason() const {
  const climb::ControllerOutput& output = box_.report().output;
  if (output.reason != climb::Fault::kNone) return climb::name(output.reason);
  if (output.refusal != climb::Refusal::kNone) return climb::name(output.refusal);
  if (output.burden != climb::Burden::kBorne) return climb::name(output.burden);
  return "";
}

}  // namespace robot_in_a_box
