// SPDX-License-Identifier: BSD-3-Clause
#include "robot_in_a_box/drill_expect.h"

namespace robot_in_a_box {
namespace {

using S = climb::ControllerState;
using simulator::kNumAxes;
using simulator::kNumLegs;
using simulator::PowerState;

bool is_torqueless(const CaseRun& run, int but_for_axis) {
  for (int axis = 0; axis < kNumAxes; ++axis) {
    const auto index = static_cast<std::size_t>(axis);
    if (axis == but_for_axis) continue;
    if (has_torque(run.truth_before().power[index]) && !has_torque(run.truth().power[index])) {
      return true;
    }
  }
  return false;
}

bool still_moves(const CaseRun& run) {
  if (run.reacted_us() < 0) return false;
  // Where it had stopped already the state tells nothing new: a limb that was being put down may
  // go on for as long as the fault may stay unfound.
  const bool had_stopped = is_latched(run.before().state);
  const std::int64_t found_us = had_stopped ? run.visible_us() + run.bound_us() : run.reacted_us();
  for (int axis = 0; axis < kNumAxes; ++axis) {
    const bool is_moved = run.axis(axis).moved_us > found_us + kRunOut_us;
    if (!simulator::is_jaw(axis) && is_moved) return true;
  }
  return false;
}

bool is_enabled_unarmed(const CaseRun& run) {
  if (!is_unpowered(run.before().state)) return false;
  for (int axis = 0; axis < kNumAxes; ++axis) {
    if (run.axis(axis).enabled_us > run.injected_us() + kT_us) return true;
  }
  return false;
}

const char* harm(const CaseRun& run, int but_for_axis) {
  if (is_enabled_unarmed(run)) return "enabled although not armed";
  if (still_moves(run)) return "a target moves 150 ms after the reaction";
  const bool comes_down = run.before().state == S::kDisarming;
  if (!comes_down && is_torqueless(run, but_for_axis)) return "an axis lost its torque";
  return harm_to_grasps(run);
}

}  // namespace

bool is_unpowered(S state) {
  return state == S::kBoot || state == S::kSelftest || state == S::kDisarmed;
}

bool is_unchanged(const CaseRun& run) {
  const S before = run.before().state;
  if (before == S::kBoot || before == S::kSelftest) return is_unpowered(run.state());
  return run.state() == before;
}

bool holds_for(const CaseRun& run, climb::FaultFlags reasons) {
  const S before = run.before().state;
  if (is_unpowered(before)) return is_unpowered(run.state());
  if (is_latched(before)) return run.state() == before && run.reason() == run.reason_before();
  if (before == S::kDisarming && run.state() == S::kDisarmed) return true;  // it was down first
  return run.state() == S::kFaultHold && (climb::flag(run.reason()) & reasons) != 0;
}

const char* harm_to_grasps(const CaseRun& run) {
  if (run.truth().fallen && !run.truth_before().fallen) return "the robot fell";
  // While it works the monitor says which claw may be opened; once it has stopped, none.
  const bool has_stopped = is_latched(run.state()) && run.reacted_us() >= 0;
  for (int leg = 0; leg < kNumLegs && has_stopped; ++leg) {
    const simulator::LegTruth& now = run.truth().legs[static_cast<std::size_t>(leg)];
    const bool was_opened = now.last_loss == simulator::LossCause::kOpened;
    if (leg == run.before().leg) continue;  // it may be put down elsewhere, or try again
    if (was_opened && now.lost_us > run.reacted_us() + kRunOut_us) return "a claw was opened";
  }
  return nullptr;
}

const char* harm_after_stop(const CaseRun& run) {
  return harm(run, -1);
}

const char* harm_but_for_axis(const CaseRun& run) {
  return harm(run, run.some_axis());
}

const char* harm_when_silent(const CaseRun& run) {
  if (run.reacted_us() >= 0 && run.last_master_frame_us() > run.reacted_us()) {
    return "a frame was sent while the bus fault is latched";
  }
  return harm_to_grasps(run);
}

void arm_meanwhile(CaseRun& run) {
  const bool is_time = run.since_us() == 200'000;
  if (is_time && is_unpowered(run.before().state)) run.box().order(climb::Order::kArm);
}

bool everywhere(const Situation&) {
  return true;
}

bool after_boot(const Situation& at) {
  return at.state != S::kBoot;
}

bool where_enabled(const Situation& at) {
  return is_powered(at.state) || at.state == S::kFaultHold ||
         (at.state == S::kArming && at.leg >= 0);
}

bool where_powered(const Situation& at) {
  return is_powered(at.state);
}

bool in_climbing(const Situation& at) {
  return at.state == S::kClimbing;
}

bool in_hold(const Situation& at) {
  return at.state == S::kHold && !at.docked;
}

bool takes_no_notice(const CaseRun& run) {
  return run.since_us() >= 300'000;
}

const char* harm_by_notice(const CaseRun& run) {
  const bool notices = run.state() == S::kFaultHold || run.state() == S::kEstop;
  return notices && !is_latched(run.before().state) ? "stopped for nothing" : harm_to_grasps(run);
}

bool rests(const CaseRun& run) {
  const bool no_grasp =
      run.reason() == climb::Fault::kGraspDisagrees || run.reason() == climb::Fault::kNoGrasp;
  return run.state() == S::kHold || (run.state() == S::kFaultHold && no_grasp);
}

std::int64_t next_message_at(const CaseRun& run) {
  return run.messages_since() > 0 ? run.injected_us() + run.messages_since() : -1;
}

const char* harm_by_reaching(const CaseRun& run) {
  for (const climb::Leg leg : climb::kLegs) {
    const climb::LimbState at = run.limb(leg);
    if (at != climb::LimbState::kLoaded && at != climb::LimbState::kSupportLost)
      return "a limb was lifted";
  }
  return harm_to_grasps(run);
}

bool follows_again(const CaseRun& run) {
  return run.report().bus_phase == can::BusPhase::kEnabled && !is_latched(run.state());
}

void reset_and_arm(CaseRun& run, std::int64_t reset_us) {
  if (run.since_us() == reset_us) run.box().order(climb::Order::kReset);
  const bool is_time = run.since_us() > reset_us + 100'000 && run.since_us() % 100'000 == 0;
  if (is_time && run.state() == S::kDisarmed) run.box().order(climb::Order::kArm);
}

const char* harm_by_next_step(const CaseRun& run) {
  for (const climb::Leg leg : climb::kLegs) {
    const climb::LimbState at = run.limb(leg);
    const bool begins = leg != run.before().leg && at != climb::LimbState::kLoaded;
    if (begins && run.since_us() > 2 * kT_us) return "another step was begun";
  }
  for (int axis = 0; axis < kNumAxes; ++axis) {
    const auto index = static_cast<std::size_t>(axis);
    const bool had = has_torque(run.truth_before().power[index]);
    if (had && !has_torque(run.truth().power[index])) return "an axis lost its torque";
  }
  return harm_to_grasps(run);
}

}  // namespace robot_in_a_box
