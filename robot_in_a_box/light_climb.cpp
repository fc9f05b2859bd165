// SPDX-License-Identifier: BSD-3-Clause
#include "robot_in_a_box/light_climb.h"

#include <algorithm>
#include <array>

namespace robot_in_a_box {
namespace {

using climb::Order;
using S = climb::ControllerState;

constexpr int kStartRung = 2;  ///< of the front claws in the dock
constexpr std::int64_t kThinking_us = 300'000;
constexpr std::int64_t kReleasing_us = 200'000;   ///< of the E-stop
constexpr std::int64_t kPatience_us = 5'000'000;  ///< in DISARMED or latched
/// While no limb moves, however often it is sent up: there is no way on.
constexpr std::int64_t kNoWayOn_us = 10'000'000;
constexpr std::uint64_t kLadderStream = 11;

double between(double low, double high, base::Rng& rng) {
  return low + (high - low) * rng.uniform();
}

void displace(simulator::LadderRung& rung, base::Rng& rng) {
  for (Eigen::Vector3d* end : {&rung.end0_m, &rung.end1_m}) {
    end->x() += between(-0.005, 0.005, rng);
    end->z() += between(-0.005, 0.005, rng);
  }
  rung.radius_m = between(0.012, 0.018, rng);
}

void damage(std::vector<simulator::LadderRung>& rungs, base::Rng& rng) {
  const auto num_to_come = static_cast<std::uint32_t>(rungs.size()) - kStartRung - 1;
  simulator::LadderRung& rung = rungs[kStartRung + 1 + rng.below(num_to_come)];
  switch (rng.below(4)) {
    case 0:
      rung.broken = true;  // missing
      return;
    case 1:
      rung.break_on_touch = true;
      return;
    case 2:
      rung.break_load_N = between(30.0, 200.0, rng);
      return;
    default:
      rung.end0_m = rung.end0_m + 0.5 * (rung.end1_m - rung.end0_m);  // a broken end
  }
}

/// Sends it up, again and again after it has stopped.
class Operator {
 public:
  Operator(const LightClimbParams& params, ClimbBox& box) : params_(params), box_(box) {}

  /// Before each cycle.
  void act() {
    if (box_.state() != state_) enter(box_.state());
    if (is_any_limb_under_way()) moved_us_ = box_.now_us();
    if (climb::is_latched(state_) && in_state_us() == kReleasing_us)
      box_.plant().press_estop(false);
    if (in_state_us() == 0 || in_state_us() % kThinking_us != 0) return;
    switch (state_) {
      case S::kDisarmed:
        return box_.order(needs_reset() ? Order::kReset : Order::kArm);
      case S::kHold:
        if (box_.plant().is_docked()) return box_.plant().set_docked(false);
        return box_.order(Order::kClimb);
      case S::kPaused:
        return box_.order(Order::kClimb);
      case S::kFaultHold:
      case S::kEstop:
        return box_.order(Order::kReset);
      default:
        return;
    }
  }
  /// No way on from here, or no more patience.
  bool gives_up() const {
    const bool stands = state_ == S::kDisarmed || climb::is_latched(state_);
    const bool has_no_way_on = state_ == S::kHold && box_.now_us() - moved_us_ > kNoWayOn_us;
    return num_stops_ > params_.max_stops || has_no_way_on ||
           (stands && in_state_us() > kPatience_us);
  }

 private:
  void enter(S state) {
    const bool is_refused = state_ == S::kArming && state == S::kDisarmed;
    if (climb::is_latched(state) || is_refused) ++num_stops_;
    state_ = state;
    since_us_ = box_.now_us();
  }
  bool is_any_limb_under_way() const {
    for (const climb::Leg leg : climb::kLegs) {
      if (box_.controller().limb(leg).moves()) return true;
    }
    return false;
  }
  std::int64_t in_state_us() const { return box_.now_us() - since_us_; }
  bool needs_reset() const { return box_.report().bus_faults.size > 0; }

  const LightClimbParams& params_;
  ClimbBox& box_;
  S state_ = S::kBoot;
  std::int64_t since_us_ = 0;
  std::int64_t moved_us_ = 0;
  int num_stops_ = 0;
};

int highest_front_rung(const simulator::PlantTruth& truth) {
  int highest = -1;
  for (const climb::Leg leg : {climb::kFrontLeft, climb::kFrontRight}) {
    const simulator::LegTruth& claw = truth.legs[static_cast<std::size_t>(leg)];
    if (claw.holds) highest = std::max(highest, claw.rung_index);
  }
  return highest;
}

LightEnd end_of(const ClimbBox& box) {
  if (box.plant().truth().fallen) return LightEnd::kFallen;
  const S at = box.state();
  if (at == S::kHold) return box.report().output.at_top ? LightEnd::kTop : LightEnd::kHeld;
  const bool stopped = climb::is_latched(at) || at == S::kDisarmed;
  return stopped ? LightEnd::kStopped : LightEnd::kTooLong;
}

bool is_at_top(const ClimbBox& box) {
  return box.state() == S::kHold && box.report().output.at_top && !box.plant().is_docked();
}

}  // namespace

const char* name(LightEnd end) {
  constexpr std::array<const char*, kNumLightEnds> kNames = {"top", "held", "stopped", "fallen",
                                                             "too long"};
  return kNames[static_cast<std::size_t>(end)];
}

ClimbBoxParams light_box_params(const LightClimbParams& params) {
  base::Rng rng(params.seed, kLadderStream);
  ClimbBoxParams box;
  box.seed = params.seed;
  simulator::LadderParams ladder;
  ladder.num_rungs = kStartRung + 1 + params.num_rungs_to_climb;
  ladder.spacing_m = between(0.25, 0.35, rng);
  box.plant.rungs = straight_ladder(ladder);
  for (simulator::LadderRung& rung : box.plant.rungs) displace(rung, rng);
  if (rng.below(2) == 0) damage(box.plant.rungs, rng);
  box.plant.body_height_m = 2.0 * ladder.spacing_m;
  box.plant.seed = params.seed;
  return box;
}

LightResult run_light_climb(const LightClimbParams& params, ClimbBox& box,
                            const std::function<void()>& each_cycle, const Tell& tell) {
  TroubleParams random;
  random.until_us = 100'000'000;
  random.max_faults = params.has_troubles ? 2 : 0;
  random.order_every = 3'000;
  random.begin_every = 2'500;
  Trouble trouble(box, params.seed, random, tell);
  box.watch(&trouble);
  Operator human(params, box);
  int highest = kStartRung;
  while (box.now_us() < params.limit_us && !is_at_top(box) && !human.gives_up() &&
         !box.plant().truth().fallen) {
    if (params.has_troubles) trouble.act(true);
    human.act();
    box.cycle();
    highest = std::max(highest, highest_front_rung(box.plant().truth()));
    if (each_cycle) each_cycle();
  }
  box.watch(nullptr);
  LightResult result;
  result.end = end_of(box);
  if (result.end == LightEnd::kHeld) result.reason = climb::name(box.report().output.refusal);
  if (result.end == LightEnd::kStopped) result.reason = climb::name(box.report().output.reason);
  result.rungs_climbed = highest - kStartRung;
  result.duration_us = box.now_us();
  return result;
}

}  // namespace robot_in_a_box
