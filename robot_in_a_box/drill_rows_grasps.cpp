// SPDX-License-Identifier: BSD-3-Clause
// The fault table as data, rows 4 to 10: targets, rungs and touch. What is injected, where it
// applies, what must happen and by when.
#include <array>

#include "robot_in_a_box/drill_expect.h"
#include "robot_in_a_box/drill_tables.h"

namespace robot_in_a_box {
namespace {

using climb::Fault;
using climb::flag;
using climb::LimbState;
using climb::Order;
using simulator::WireFault;
using S = climb::ControllerState;

/// A jaw that presses anew leaves its rung's window where no rung is: 0.13 of the 0.16 rad to its
/// stop, its target at 5 rad/s and its drive 30 ms behind that. One cycle before, the first target
/// is the measured one.
constexpr std::int64_t kJawTravel_us = 70'000;

bool works(const Situation& at) {
  return at.state == S::kClimbing || at.state == S::kArming;
}

// --- row 4: nothing in reach ---------------------------------------------------------------------

bool decides_next(const Situation& at) {
  const bool is_committed = at.limb == LimbState::kApproach || at.limb == LimbState::kClosing ||
                            at.limb == LimbState::kVerify || at.limb == LimbState::kLoading;
  return at.state == S::kClimbing && (at.shifts || is_committed);
}
void see_only_far(CaseRun& run) {
  run.box().perception().seen_from_m = 0.75;
}
std::int64_t decision_due_at(const CaseRun& run) {
  if (run.messages_since() <= 0 || run.report().output.body_shift) return -1;
  for (const climb::Leg leg : climb::kLegs) {
    if (run.limb(leg) != LimbState::kLoaded) return -1;
  }
  return run.now_us();
}
bool is_refused(const CaseRun& run) {
  const bool named = run.report().output.refusal != climb::Refusal::kNone;
  return run.state() == S::kHold && named;
}
void climb_anyway(CaseRun& run) {
  if (run.since_us() == 200'000) run.box().order(Order::kClimb);
}
std::int64_t climbed_anyway_at(const CaseRun& run) {
  return run.report().order == Order::kClimb && run.since_us() >= 200'000 ? run.now_us() : -1;
}

// --- row 5: the target is withdrawn --------------------------------------------------------------

bool not_committed(const Situation& at) {
  return at.state == S::kClimbing &&
         (at.limb == LimbState::kUnloading || at.limb == LimbState::kRetracting ||
          at.limb == LimbState::kTransit || at.limb == LimbState::kPregrasp);
}
bool committed(const Situation& at) {
  return at.state == S::kClimbing &&
         (at.limb == LimbState::kClosing || at.limb == LimbState::kApproach);
}
void withdraw(CaseRun& run) {
  const auto leg = static_cast<climb::Leg>(run.moving_leg());
  run.box().perception().withdrawn_rung = run.box().controller().limb(leg).goal().rung_id;
}
bool turns_back(const CaseRun& run) {
  const LimbState at = run.limb(run.moving_leg());
  return at == LimbState::kAbortReturn || at == LimbState::kLoading || at == LimbState::kLoaded;
}
bool holds_again(const CaseRun& run) {
  const auto leg = static_cast<std::size_t>(run.moving_leg());
  return run.limb(run.moving_leg()) == LimbState::kLoaded && run.truth().legs[leg].bears;
}
const char* harm_by_turning_back(const CaseRun& run) {
  if (run.limb(run.moving_leg()) == LimbState::kAbortReturn) return "turned back after the commit";
  return harm_to_grasps(run);
}

// --- rows 6 and 7: rungs break -------------------------------------------------------------------

bool is_loading(const Situation& at) {
  return works(at) && at.limb == LimbState::kLoading;
}
bool is_verified(const Situation& at) {
  return works(at) && at.limb == LimbState::kVerify;
}
bool comes_close(const Situation& at) {
  return works(at) && (at.limb == LimbState::kApproach || at.limb == LimbState::kClosing);
}
void break_rung(CaseRun& run, int rung) {
  if (rung >= 0) run.box().plant().world().rung(rung).break_at_us = run.now_us();
}
void break_target(CaseRun& run) {
  const auto leg = static_cast<climb::Leg>(run.moving_leg());
  break_rung(run, run.box().controller().limb(leg).goal().rung_id);
}
std::int64_t touch_opened_at(const CaseRun& run, int leg) {
  const auto index = static_cast<std::size_t>(leg);
  const bool was = run.truth_before().legs[index].touch;
  return was && !run.truth().legs[index].touch ? run.now_us() : -1;
}
std::int64_t target_touch_opened_at(const CaseRun& run) {
  return touch_opened_at(run, run.moving_leg());
}
std::int64_t jaw_empty_at(const CaseRun& run) {
  const int leg = run.moving_leg();
  const double jaw = run.truth().joint_rad[static_cast<std::size_t>(simulator::axis_of(leg, 3))];
  return run.limb(leg) == LimbState::kClosing && jaw < -0.55 ? run.now_us() : -1;
}
bool lets_go(const CaseRun& run) {
  const LimbState at = run.limb(run.moving_leg());
  return at == LimbState::kRegrasp || at == LimbState::kSupportLost || at == LimbState::kPregrasp ||
         at == LimbState::kAbortReturn || run.state() == S::kFaultHold;
}
/// A fall may follow from physics; opened claws may not.
const char* harm_by_unloading(const CaseRun& run) {
  const char* harm = harm_to_grasps(run);
  return run.truth().fallen ? nullptr : harm;
}

bool is_enabling(const Situation& at) {
  return at.state == S::kArming && !at.follows;
}
bool has_stance(const Situation& at) {
  const bool may_hang = is_powered(at.state) || at.state == S::kArming;
  return (may_hang && !is_enabling(at)) || at.state == S::kFaultHold;
}
void break_stance(CaseRun& run) {
  break_rung(run, run.box().plant().leg(run.stance_leg()).rung_index);
}
std::size_t index_of_stance(const CaseRun& run) {
  return static_cast<std::size_t>(run.stance_leg());
}
std::int64_t stance_touch_opened_at(const CaseRun& run) {
  const bool counted = run.limb(run.stance_leg()) == LimbState::kLoaded ||
                       run.limb(run.stance_leg()) == LimbState::kSupportLost;
  return counted ? touch_opened_at(run, run.stance_leg()) : -1;
}
/// Drives that are being enabled hold where they are measured: no jaw presses, so no switch tells
/// anything. The first target after that lets the jaw press, or close on nothing.
std::int64_t stance_pressed_at(const CaseRun& run) {
  const std::size_t leg = index_of_stance(run);
  const bool was_counted =
      run.truth_before().legs[leg].holds && run.limb(run.stance_leg()) == LimbState::kLoaded;
  const bool is_gone = was_counted && !run.truth().legs[leg].holds;
  return is_gone && run.report().output.send ? run.now_us() : -1;
}
bool stops_for_stance(const CaseRun& run) {
  return holds_for(run, flag(Fault::kStanceLost) | flag(Fault::kTooFewGrasps) |
                            flag(Fault::kFreeFall) | flag(Fault::kTilt) | flag(Fault::kTracking));
}

// --- rows 8 to 10: touch -------------------------------------------------------------------------

bool approaches(const Situation& at) {
  return works(at) && at.limb == LimbState::kApproach;
}
void set_touch(CaseRun& run, WireFault fault) {
  run.box().plant().set_wire_fault(static_cast<simulator::Line>(run.moving_leg()), fault);
}
void open_touch(CaseRun& run) {
  set_touch(run, WireFault::kStuckLow);
}
void close_touch(CaseRun& run) {
  set_touch(run, WireFault::kStuckHigh);
}
std::int64_t closing_since(const CaseRun& run) {
  return run.limb(run.moving_leg()) == LimbState::kClosing ? run.now_us() : -1;
}
bool tries_again(const CaseRun& run) {
  return run.limb(run.moving_leg()) == LimbState::kRegrasp || run.state() == S::kFaultHold;
}
bool gave_up(const CaseRun& run) {
  return run.limb(run.moving_leg()) == LimbState::kAbortReturn || run.state() == S::kFaultHold;
}
const char* harm_by_trusting(const CaseRun& run) {
  const LimbState at = run.limb(run.moving_leg());
  const bool trusts = at == LimbState::kLoading || at == LimbState::kLoaded;
  return trusts && run.state() != S::kDisarmed ? "a grasp was believed" : harm_to_grasps(run);
}

bool has_open_claw(const Situation& at) {
  const bool is_open = at.limb == LimbState::kRetracting || at.limb == LimbState::kTransit ||
                       at.limb == LimbState::kPregrasp || at.limb == LimbState::kApproach ||
                       at.limb == LimbState::kReleasing || at.limb == LimbState::kAbortReturn;
  return is_unpowered(at.state) ? at.docked && at.leg < 0 : at.leg >= 0 && is_open;
}
std::int64_t stands_open_at(const CaseRun& run) {
  const int axis = simulator::axis_of(run.moving_leg(), 3);
  const double jaw = run.truth().joint_rad[static_cast<std::size_t>(axis)];
  return run.since_us() > 0 && jaw >= 0.9 ? run.now_us() : -1;
}
bool finds_stuck_touch(const CaseRun& run) {
  const bool unpowered = is_unpowered(run.before().state);
  if (!unpowered) return holds_for(run, flag(Fault::kTouchStuck));
  // In BOOT nobody looks yet; it shows at the latest when it is to be armed.
  return is_unpowered(run.state()) &&
         (run.reason() == Fault::kTouchStuck || run.state() == S::kBoot);
}
bool is_closing(const Situation& at) {
  return works(at) && at.limb == LimbState::kClosing;
}
void break_and_close_touch(CaseRun& run) {
  break_target(run);
  close_touch(run);
}

constexpr std::array kGraspRows = {
    DrillRow{4, "a", "nothing in reach", "only far rungs are seen", "HOLD, reason told",
             decides_next, 1, see_only_far, decision_due_at, is_refused, harm_to_grasps, nullptr,
             2 * kT_us, 6'000'000},
    DrillRow{4, "b", "nothing in reach", "far rungs only, then the order to climb",
             "HOLD, reason told", in_hold, 1, see_only_far, climbed_anyway_at, is_refused,
             harm_by_reaching, climb_anyway, 2 * kT_us, 1'500'000},
    DrillRow{5, "a", "target withdrawn before commit", "its rung is flagged as damaged",
             "ABORT_RETURN", not_committed, 1, withdraw, next_message_at, turns_back,
             harm_to_grasps, nullptr, 2 * kT_us, 500'000},
    DrillRow{5, "b", "target withdrawn before commit", "its rung is flagged as damaged",
             "back on the old rung", not_committed, 1, withdraw, next_message_at, holds_again,
             harm_to_grasps, nullptr, 12'000'000, 12'500'000},
    DrillRow{5, "c", "target withdrawn after commit", "its rung is flagged as damaged",
             "goes on to the contact test", committed, 1, withdraw, next_message_at, holds_again,
             harm_by_turning_back, nullptr, 6'000'000, 6'500'000},
    DrillRow{6, "a", "target rung breaks", "while it is loaded", "released, others hold",
             is_loading, 1, break_target, target_touch_opened_at, lets_go, harm_by_unloading,
             nullptr, 2 * kT_us + 20'000, 1'000'000},
    DrillRow{6, "b", "target rung breaks", "in the pull test", "not confirmed", is_verified, 1,
             break_target, target_touch_opened_at, lets_go, harm_by_unloading, nullptr,
             310'000 + kT_us, 1'500'000},
    DrillRow{6, "c", "target rung breaks", "before the claw closes", "not confirmed", comes_close,
             1, break_target, jaw_empty_at, lets_go, harm_by_unloading, nullptr, 2'000'000 + kT_us,
             6'000'000},
    DrillRow{7, "a", "stance rung breaks", "the rung of a limb that holds",
             "FAULT_HOLD, SUPPORT_LOST", has_stance, 3, break_stance, stance_touch_opened_at,
             stops_for_stance, harm_by_unloading, nullptr, 2 * kT_us + 20'000, 1'000'000},
    DrillRow{7, "b", "stance rung breaks", "while drives are being enabled",
             "FAULT_HOLD when jaws press again", is_enabling, 3, break_stance, stance_pressed_at,
             stops_for_stance, harm_by_unloading, nullptr, kJawTravel_us + 3 * kT_us + 20'000,
             1'000'000},
    DrillRow{8, "a", "touch never arrives", "switch stuck open", "REGRASP", approaches, 1,
             open_touch, closing_since, tries_again, harm_by_trusting, nullptr, 2'000'000 + kT_us,
             6'000'000},
    DrillRow{8, "b", "touch never arrives", "switch stuck open", "tries end", approaches, 1,
             open_touch, closing_since, gave_up, harm_by_trusting, nullptr, 20'000'000, 24'000'000},
    DrillRow{9, "", "touch stuck closed", "switch closed, claw open", "FAULT_HOLD or not armed",
             has_open_claw, 1, close_touch, stands_open_at, finds_stuck_touch, harm_after_stop,
             arm_meanwhile, 100'000 + kT_us, 1'000'000},
    DrillRow{10, "a", "touch and jaw disagree", "switch closed, claw empty", "not confirmed",
             is_closing, 1, break_and_close_touch, jaw_empty_at, tries_again, harm_by_trusting,
             nullptr, 2'000'000 + kT_us, 5'000'000},
    DrillRow{10, "b", "touch and jaw disagree", "switch open, claw full, every try",
             "FAULT_HOLD or given up", is_closing, 1, open_touch, closing_since, gave_up,
             harm_by_trusting, nullptr, 20'000'000, 24'000'000},
};

}  // namespace

std::span<const DrillRow> rows_of_grasps() {
  return kGraspRows;
}

}  // namespace robot_in_a_box
