// SPDX-License-Identifier: BSD-3-Clause
#include "robot_in_a_box/trouble.h"

#include <array>
#include <utility>

#include "robot_in_a_box/situation.h"

namespace robot_in_a_box {
namespace {

std::vector<simulator::Fault> script(std::uint64_t seed, const TroubleParams& params,
                                     const ClimbBox& box) {
  base::Rng rng(seed, 3);
  simulator::RandomFaultParams random;
  const auto max_faults = static_cast<std::uint32_t>(params.max_faults);
  random.num_faults = max_faults == 0 ? 0 : 1 + static_cast<int>(rng.below(max_faults));
  random.from_us = box.now_us();
  random.until_us = box.now_us() + params.until_us;
  random.num_rungs = box.plant().world().num_rungs();
  return simulator::random_faults(rng.next(), random);
}

/// All that an observer would want to know of this millisecond.
std::string all_of(const ClimbBox& box, const simulator::PlantTruth& truth) {
  const climb_controller::CycleReport& report = box.report();
  std::string words = climb::name(report.output.state);
  if (report.output.reason != climb::Fault::kNone) {
    words += std::string(" for ") + climb::name(report.output.reason);
  }
  words += std::string(", bus ") + can::name(report.bus_phase);
  constexpr std::array<const char*, climb::kNumLegs> kLegs = {"FL", "FR", "RL", "RR"};
  for (const climb::Leg leg : climb::kLegs) {
    const simulator::LegTruth& claw = truth.legs[static_cast<std::size_t>(leg)];
    words += std::string(", ") + kLegs[static_cast<std::size_t>(leg)] + " " +
             climb::name(report.output.limbs[leg]);
    words += claw.bears ? "" : claw.holds ? " (limp)" : " (off)";
    words += claw.touch ? "" : " no touch";
  }
  if (truth.docked) words += ", docked";
  if (truth.fallen) words += ", fallen";
  return words;
}

}  // namespace

Trouble::Trouble(ClimbBox& box, std::uint64_t seed, const TroubleParams& params, Tell tell)
    : box_(box),
      params_(params),
      rng_(seed, 2),
      faults_(script(seed, params, box)),
      player_(faults_, box.bus()),
      tell_(std::move(tell)) {}

void Trouble::before(std::int64_t now_us) {
  const int num_begun = player_.num_begun();
  player_.apply(now_us, box_.plant(), box_.bus());
  for (int i = num_begun; i < player_.num_begun(); ++i) {
    say("fault: " + to_text(faults_[static_cast<std::size_t>(i)]));
  }
}

void Trouble::act(bool may_begin) {
  if (params_.order_every > 0 && rng_.below(params_.order_every) == 0) give_order();
  box_.imu_silent = box_.imu_silent && rng_.below(20) != 0;
  box_.perception().silent = box_.perception().silent && rng_.below(40) != 0;
  if (rng_.below(50) == 0) box_.perception().nonsense = Nonsense::kNone;
  if (may_begin && rng_.below(params_.begin_every) == 0) begin();
}

void Trouble::begin() {
  switch (rng_.below(6)) {
    case 0:
      say("the controller hangs");
      return box_.hang(5'000 * (1 + rng_.below(60)));
    case 1:
      say("the IMU is silent");
      box_.imu_silent = true;
      return;
    case 2:
      say("perception is silent");
      box_.perception().silent = true;
      return;
    case 3:
      say("perception speaks nonsense");
      box_.perception().nonsense = static_cast<Nonsense>(1 + rng_.below(7));
      return;
    case 4:
      say("the machine sleeps");
      return box_.sleep(100'000 * (1 + rng_.below(100)));
    default:
      say("a rung is withdrawn");
      box_.perception().withdrawn_rung = static_cast<int>(rng_.below(9));
  }
}

void Trouble::give_order() {
  using climb::Order;
  constexpr std::array<Order, 8> kOrders = {Order::kArm,   Order::kClimb, Order::kClimb,
                                            Order::kPause, Order::kHold,  Order::kReset,
                                            Order::kReset, Order::kArm};
  constexpr std::array<const char*, 8> kNames = {"arm",  "climb", "climb", "pause",
                                                 "hold", "reset", "reset", "arm"};
  const std::uint32_t which = rng_.below(8);
  say(std::string("ordered: ") + kNames[which]);
  box_.order(kOrders[which]);
}

void Trouble::on_truth(const simulator::PlantTruth& truth) {
  if (!tell_) return;
  const std::string now = all_of(box_, truth);
  if (now != told_) say(now);
  told_ = now;
  const auto& violations = box_.monitor().violations();
  for (; num_violations_told_ < violations.size(); ++num_violations_told_) {
    say("VIOLATED: " + describe(violations[num_violations_told_]));
  }
}

void Trouble::say(const std::string& what) const {
  if (tell_) tell_(std::to_string(box_.now_us() / 1000) + " ms  " + what);
}

}  // namespace robot_in_a_box
