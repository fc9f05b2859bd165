// SPDX-License-Identifier: BSD-3-Clause
#include "robot_in_a_box/closed_loop.h"

#include <array>
#include <cstdio>

namespace robot_in_a_box {
namespace {

using climb::ControllerState;
using climb::Order;

constexpr double kGone_s = 1.0;   ///< until systemd has a service back
constexpr double kBack_s = 60.0;  ///< until it must climb again, or stand with a reason
constexpr double kLimbInTheAir_s = 60.0;
constexpr double kOldLog_s = 3.0;
constexpr int kThinking_cycles = 50;  ///< of the operator, between two orders
constexpr int kFloodPerCycle = 100;   ///< messages: 10 000 a second
// Bounds of docs/SAFETY.md in ms; T = 10. What the plant does is seen a cycle later.
constexpr double kPerceptionBound_ms = 310.0 + 10.0;
constexpr double kDriveStopBound_ms = 150.0 + 10.0;
constexpr double kEstopBound_ms = 20.0 + 10.0;

std::string text_of(const char* format, auto... values) {
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(), format, values...);
  return text.data();
}

}  // namespace

const char* name(Mishap mishap) {
  constexpr std::array<const char*, kNumMishaps> kNames = {
      "kill_sensor", "kill_gng",  "kill_ladder", "kill_controller", "estop",
      "one_head",    "two_heads", "flood",       "old_log"};
  return kNames[static_cast<std::size_t>(mishap)];
}

ClosedLoop::ClosedLoop(const ClosedLoopParams& params, const runtime::Config& config)
    : params_(params),
      full_(params.climb, config),
      climb_(full_.climb()),
      box_(climb_.box()),
      rng_(params.seed, 31) {}

ClosedLoopResult ClosedLoop::run(std::function<void(const std::string&)> tell) {
  tell_ = std::move(tell);
  if (params_.mishap == Mishap::kOldLog) keep_log();
  climb_.run_s(3.0);
  result_.has_hung = climb_.hang();
  if (!result_.has_hung || !go_on(kBack_s)) miss("it never climbed: " + state_in_words());
  while (climbs() && static_cast<int>(result_.rows.size()) < params_.num_times) {
    const double share = rng_.uniform();
    cycles_s(params_.least_pause_s + share * (params_.most_pause_s - params_.least_pause_s));
    if (!climbs() && !go_on(kBack_s)) {
      if (climb_.reason().empty()) miss("it stands without a mishap: " + state_in_words());
      break;
    }
    MishapRow row;
    suffer(row);
    result_.rows.push_back(row);
    tell_row(row);
  }
  const simulator::Figures& figures = climb_.figures();
  result_.falls = figures.falls;
  result_.rungs_climbed = figures.rungs_climbed;
  result_.min_support = figures.min_support;
  result_.num_violations = box_.monitor().num_violations();
  if (result_.falls > 0) miss("it fell");
  for (const simulator::Violation& violation : box_.monitor().violations()) {
    miss(describe(violation));
  }
  return result_;
}

void ClosedLoop::tell_row(const MishapRow& row) const {
  if (!tell_) return;
  tell_(text_of("%8.1f s  %s  %s  reaction %.0f ms, climbs again after %.1f s  %s", row.at_s,
                name(params_.mishap), row.limbs.c_str(), row.reaction_ms, row.back_s,
                row.end.c_str()));
}

void ClosedLoop::cycle() {
  box_.cycle();
}

void ClosedLoop::cycles_s(double duration_s) {
  for (int i = 0; i < static_cast<int>(100.0 * duration_s); ++i) cycle();
}

bool ClosedLoop::climbs() const {
  return box_.state() == ControllerState::kClimbing;
}

double ClosedLoop::ms_until(const std::function<bool()>& condition, double within_s) {
  const std::int64_t start_us = box_.now_us();
  while (!condition()) {
    if (1e-6 * static_cast<double>(box_.now_us() - start_us) > within_s) return -1.0;
    cycle();
  }
  return 1e-3 * static_cast<double>(box_.now_us() - start_us);
}

bool ClosedLoop::go_on(double within_s) {
  int num_waited = 0;
  const auto climbs_again = [&] {
    const bool fallen = box_.plant().truth().fallen;
    if (!climbs() && !fallen && ++num_waited % kThinking_cycles == 0) give_order();
    return climbs() || fallen;
  };
  return ms_until(climbs_again, within_s) >= 0.0 && climbs();
}

void ClosedLoop::give_order() {
  switch (box_.state()) {
    case ControllerState::kDisarmed:
      return box_.order(Order::kArm);
    case ControllerState::kHold:
      if (box_.plant().is_docked()) return box_.plant().set_docked(false);
      if (box_.report().output.at_top) upwards_ = false;
      if (box_.report().output.at_dock && !upwards_) upwards_ = true;
      return box_.order(upwards_ ? Order::kClimb : Order::kClimbDown);
    case ControllerState::kPaused:
      return box_.order(upwards_ ? Order::kClimb : Order::kClimbDown);
    case ControllerState::kFaultHold:
    case ControllerState::kEstop:
      return box_.order(Order::kReset);
    default:
      return;
  }
}

void ClosedLoop::suffer(MishapRow& row) {
  if (params_.mishap == Mishap::kEstop) wait_for_limb_in_the_air();
  row.at_s = 1e-6 * static_cast<double>(box_.now_us());
  row.limbs = limbs_in_words();
  switch (params_.mishap) {
    case Mishap::kKillSensor:
      lose_service("sensor", row);
      break;
    case Mishap::kKillGng:
      lose_service("gng", row);
      break;
    case Mishap::kKillLadder:
      lose_service("ladder", row);
      break;
    case Mishap::kKillController:
      lose_controller(row);
      break;
    case Mishap::kEstop:
      press_estop(row);
      break;
    case Mishap::kOneHead:
      lose_heads(1, row);
      break;
    case Mishap::kTwoHeads:
      lose_heads(2, row);
      break;
    case Mishap::kFlood:
      flood(row);
      break;
    case Mishap::kOldLog:
      play_old_log(row);
      break;
  }
  const std::int64_t since_us = box_.now_us();
  const bool is_back = go_on(kBack_s);
  if (is_back) row.back_s = 1e-6 * static_cast<double>(box_.now_us() - since_us);
  row.end = state_in_words();
  const bool stands_with_reason = !is_back && !climb_.reason().empty();
  if (!is_back && !stands_with_reason) miss("it does not go on, and tells no reason");
}

// Row 1: no rungs for 300 ms, PROTECTIVE_HOLD, and on by itself when they are back.
void ClosedLoop::lose_service(const std::string& service, MishapRow& row) {
  full_.eyes().chain().kill(service);
  const auto stands = [&] { return !climbs(); };
  const double until_ms = ms_until(stands, 2.0);
  row.reaction_ms = 1e-3 * static_cast<double>(box_.now_us() - full_.eyes().received_us());
  if (until_ms < 0.0) miss("it climbs on without perception");
  const bool has_ended = box_.state() == ControllerState::kHold;  // its step was the last
  if (!has_ended && row.reaction_ms > kPerceptionBound_ms) {
    miss(text_of("perception silent after %.0f ms", row.reaction_ms));
  }
  cycles_s(kGone_s);
  full_.eyes().chain().start_anew(service);
}

// Row 20: the drives stop and hold by themselves; the next controller is disarmed and enables
// nothing unasked. Armed where it hangs it finds out what its claws hold, and climbs on.
void ClosedLoop::lose_controller(MishapRow& row) {
  box_.kill();
  const auto all_stop = [this] {
    return num_drives_in(simulator::PowerState::kQuickStopActive) == simulator::kNumAxes;
  };
  row.reaction_ms = ms_until(all_stop, 1.0);
  if (row.reaction_ms < 0.0 || row.reaction_ms > kDriveStopBound_ms) {
    miss(text_of("drives stop after %.0f ms", row.reaction_ms));
  }
  cycles_s(kGone_s);
  box_.start_anew();
  full_.eyes().forget_controller();
  // Odom begins anew where the robot hangs: what perception knows is elsewhere.
  for (const char* service : {"sensor", "gng", "ladder"}) {
    full_.eyes().chain().start_anew(service);
  }
  const auto is_disarmed = [this] { return box_.state() == ControllerState::kDisarmed; };
  if (ms_until(is_disarmed, 20.0) < 0.0) miss("never disarmed: " + state_in_words());
  cycles_s(2.0);
  if (!is_disarmed() || num_drives_in(simulator::PowerState::kOperationEnabled) > 0) {
    miss("a new controller enables drives that nobody armed");
  }
}

// Rows 23 and 24: ESTOP, and nothing moves when the button is let go.
void ClosedLoop::press_estop(MishapRow& row) {
  box_.plant().press_estop(true);
  const auto is_stopped = [this] {
    return box_.state() == ControllerState::kEstop &&
           num_drives_in(simulator::PowerState::kOperationEnabled) == 0;
  };
  row.reaction_ms = ms_until(is_stopped, 1.0);
  if (row.reaction_ms < 0.0 || row.reaction_ms > kEstopBound_ms) {
    miss(text_of("ESTOP after %.0f ms", row.reaction_ms));
  }
  cycles_s(2.0);
  box_.plant().press_estop(false);
  cycles_s(1.0);
  if (!is_stopped()) miss("a released E-stop is followed by " + state_in_words());
}

/// Whatever it sees with the others; the head is back after a while.
void ClosedLoop::lose_heads(int num_heads, MishapRow&) {
  const auto first = static_cast<int>(rng_.below(simulator::kNumHeads));
  for (int i = 0; i < num_heads; ++i) {
    full_.eyes().heads().set_dead((first + i) % simulator::kNumHeads, true);
  }
  cycles_s(10.0);
  for (int head = 0; head < simulator::kNumHeads; ++head) {
    full_.eyes().heads().set_dead(head, false);
  }
}

/// Rows 2, 3, 28, 31: noise on every input and orders of strangers, for a second.
void ClosedLoop::flood(MishapRow&) {
  constexpr std::array<const char*, 5> kChannels = {"LADDER_TOF_0", "LADDER_IMU", "LADDER_POSE",
                                                    "LADDER_CLOUD", "LADDER_TOPOLOGY"};
  std::vector<std::uint8_t> noise(1400);
  for (int i = 0; i < 100; ++i) {
    for (int k = 0; k < kFloodPerCycle; ++k) {
      for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(rng_.below(256));
      const auto num_bytes = rng_.below(static_cast<std::uint32_t>(noise.size()));
      full_.eyes().feed(kChannels[rng_.below(kChannels.size())], noise.data(), num_bytes);
      box_.order({Order::kDisarm, rng_.next(), static_cast<std::int64_t>(rng_.below(1000))});
    }
    cycle();
  }
}

/// Row 28: what an earlier session recorded, its orders too, comes again.
void ClosedLoop::play_old_log(MishapRow&) {
  const std::size_t num_per_cycle = old_log_.size() / static_cast<std::size_t>(100.0 * kOldLog_s);
  for (std::size_t i = 0; i < old_log_.size(); ++i) {
    const OldMessage& old = old_log_[i];
    full_.eyes().feed(old.channel.c_str(), old.bytes.data(), old.bytes.size());
    if (num_per_cycle == 0 || i % num_per_cycle != 0) continue;
    for (const Order order : {Order::kArm, Order::kClimb, Order::kDisarm}) {
      ++old_order_.seq;
      box_.order({order, old_order_.session_id, old_order_.seq});
    }
    cycle();
  }
}

void ClosedLoop::keep_log() {
  old_order_.session_id = base::Rng(params_.seed, 32).next() | 1U;
  full_.eyes().log_to(
      [this](const char* channel, const void* bytes, std::size_t num_bytes, std::int64_t) {
        if (1e-6 * static_cast<double>(box_.now_us()) > kOldLog_s) return;
        const auto* first = static_cast<const std::uint8_t*>(bytes);
        old_log_.push_back({channel, std::vector<std::uint8_t>(first, first + num_bytes)});
      });
}

void ClosedLoop::wait_for_limb_in_the_air() {
  const auto is_in_the_air = [this] {
    for (const climb::Leg leg : climb::kLegs) {
      const climb::LimbState state = box_.report().output.limbs[leg];
      if (state == climb::LimbState::kTransit || state == climb::LimbState::kApproach) return true;
    }
    return false;
  };
  int num_waited = 0;
  ms_until(
      [&] {
        if (!climbs() && ++num_waited % kThinking_cycles == 0) give_order();
        return is_in_the_air();
      },
      kLimbInTheAir_s);
}

int ClosedLoop::num_drives_in(simulator::PowerState state) const {
  int num = 0;
  for (int axis = 0; axis < simulator::kNumAxes; ++axis) {
    num += box_.plant().drive(axis).power_state() == state ? 1 : 0;
  }
  return num;
}

void ClosedLoop::miss(const std::string& what) {
  result_.missed.push_back(text_of("%.2f s: ", 1e-6 * static_cast<double>(box_.now_us())) + what);
  if (tell_) tell_("MISSED " + result_.missed.back());
}

std::string ClosedLoop::state_in_words() const {
  const std::string why = climb_.reason();
  return climb::name(box_.state()) + (why.empty() ? "" : " (" + why + ")");
}

std::string ClosedLoop::limbs_in_words() const {
  std::string text;
  for (const climb::Leg leg : climb::kLegs) {
    const climb::LimbState state = box_.report().output.limbs[leg];
    if (state != climb::LimbState::kLoaded) {
      text += std::string(text.empty() ? "" : ", ") + climb::name(leg) + " " + climb::name(state);
    }
  }
  return text.empty() ? "all loaded" : text;
}

}  // namespace robot_in_a_box
