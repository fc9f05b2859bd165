// SPDX-License-Identifier: BSD-3-Clause
#include "robot_in_a_box/tour.h"

#include <algorithm>

namespace robot_in_a_box {
namespace {

using climb::LimbState;
using climb::Order;
using S = climb::ControllerState;

constexpr std::int64_t kThinking_us = 300'000;   ///< an operator's time from state to order
constexpr std::int64_t kReleasing_us = 200'000;  ///< of the E-stop
constexpr std::int64_t kLongest_us = 600'000'000;

}  // namespace

const char* name(TourKind kind) {
  constexpr std::array<const char*, kNumTourKinds> kNames = {
      "climb",  "pauses",  "silences", "misses",  "withdrawals", "stops",
      "estops", "lost FL", "lost FR",  "lost RL", "lost RR"};
  return kNames[static_cast<std::size_t>(kind)];
}

ClimbBoxParams tour_params(TourKind kind, std::uint64_t seed) {
  ClimbBoxParams params;
  params.seed = seed;
  simulator::LadderParams ladder;
  const bool is_long = kind == TourKind::kSilences || kind == TourKind::kStops ||
                       kind == TourKind::kEstops || kind == TourKind::kPauses;
  ladder.num_rungs = is_long ? 9 : 5;
  params.plant.rungs = straight_ladder(ladder);
  params.plant.seed = seed;
  return params;
}

void Tour::act() {
  if (box_.state() != state_) {
    state_ = box_.state();
    state_since_us_ = box_.now_us();
  }
  if (box_.now_us() > kLongest_us) over_ = true;
  trouble();
  work_through();
}

void Tour::work_through() {
  // One order per state, after a while, and again when nothing came of it.
  const bool is_latched = climb::is_latched(state_);
  if (is_latched && in_state_us() == kReleasing_us) box_.plant().press_estop(false);
  if (in_state_us() == 0 || in_state_us() % kThinking_us != 0) return;
  switch (state_) {
    case S::kDisarmed:
      if (was_up_ && box_.report().output.at_top) {
        over_ = true;
        return;
      }
      return box_.order(Order::kArm);
    case S::kHold:
      if (box_.plant().is_docked()) {
        box_.plant().set_docked(false);
        state_since_us_ = box_.now_us();
        return;
      }
      was_up_ = box_.report().output.at_top;
      return box_.order(was_up_ ? Order::kDisarm : Order::kClimb);
    case S::kPaused:
      return box_.order(Order::kClimb);
    case S::kFaultHold:
    case S::kEstop:
      return box_.order(Order::kReset);
    default:
      return;
  }
}

void Tour::trouble() {
  switch (kind_) {
    case TourKind::kClimb:
      return;
    case TourKind::kPauses:
      return pause();
    case TourKind::kSilences:
      return silence();
    case TourKind::kMisses:
      return miss();
    case TourKind::kWithdrawals:
      return withdraw();
    case TourKind::kStops:
      return stop(false);
    case TourKind::kEstops:
      return stop(true);
    case TourKind::kLostFrontLeft:
    case TourKind::kLostFrontRight:
    case TourKind::kLostRearLeft:
    case TourKind::kLostRearRight:
      return lose(climb::kLegs[static_cast<std::size_t>(kind_) -
                               static_cast<std::size_t>(TourKind::kLostFrontLeft)]);
  }
}

bool Tour::is_new() {
  return troubled_.insert(situation_of(box_)).second;
}

void Tour::pause() {
  if (state_ == S::kClimbing && is_new()) box_.order(Order::kPause);
}

void Tour::silence() {
  PerceivedLadder& perception = box_.perception();
  if (perception.silent) {
    const bool had_enough = box_.now_us() - trouble_since_us_ > 500'000;
    if (had_enough) perception.silent = false;
    next_trouble_us_ = box_.now_us() + 100'000 + 10'000 * rng_.below(120);
  } else if (state_ == S::kClimbing && box_.now_us() >= next_trouble_us_) {
    perception.silent = true;
    trouble_since_us_ = box_.now_us();
  }
}

void Tour::miss() {
  // Twice per leg: in the dock and on the ladder.
  for (const climb::Leg leg : climb::kLegs) {
    const LimbState limb = box_.report().output.limbs[leg];
    const auto line = static_cast<simulator::Line>(leg);
    if (limb == LimbState::kClosing && leg_in_trouble_ < 0 &&
        num_done_[leg] < (box_.plant().is_docked() ? 1 : 2)) {
      leg_in_trouble_ = leg;
      box_.plant().set_wire_fault(line, simulator::WireFault::kStuckLow);
    }
    if (leg_in_trouble_ == leg && limb == LimbState::kRegrasp) {
      leg_in_trouble_ = -1;
      ++num_done_[leg];
      box_.plant().set_wire_fault(line, simulator::WireFault::kNone);
    }
  }
}

void Tour::withdraw() {
  for (const climb::Leg leg : climb::kLegs) {
    const climb::LimbCycle& limb = box_.controller().limb(leg);
    if (limb.state() == LimbState::kTransit && state_ == S::kClimbing && num_done_[leg] == 0) {
      num_done_[leg] = 1;
      box_.perception().withdrawn_rung = limb.goal().rung_id;
    }
  }
  if (state_ == S::kHold) box_.perception().withdrawn_rung = -1;
}

void Tour::stop(bool by_estop) {
  box_.clear_flag(climb::Fault::kOverrun);
  const bool may_stop = is_powered(state_) || state_ == S::kArming;
  if (!may_stop || !is_new()) return;
  if (by_estop) {
    box_.plant().press_estop(true);
  } else {
    box_.flag_fault(climb::Fault::kOverrun);
  }
}

void Tour::lose(climb::Leg leg) {
  const Situation now = situation_of(box_);
  bool is_alone = true;
  for (const climb::Leg other : climb::kLegs) {
    if (other == leg) continue;
    if (box_.plant().leg(other).rung_index == box_.plant().leg(leg).rung_index) {
      is_alone = false;
    }
  }
  const bool is_time = is_alone && now.state == S::kClimbing && now.limb == LimbState::kTransit;
  if (is_time && now.leg != leg && leg_in_trouble_ < 0) {
    leg_in_trouble_ = leg;
    const int rung = box_.plant().leg(leg).rung_index;
    if (rung >= 0) box_.plant().world().rung(rung).break_at_us = box_.now_us();
    next_trouble_us_ = box_.now_us() + 1'000'000;
  }
  if (leg_in_trouble_ == leg && box_.now_us() > next_trouble_us_) over_ = true;
}

}  // namespace robot_in_a_box
