// SPDX-License-Identifier: BSD-3-Clause
#include "robot_in_a_box/drill_case.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace robot_in_a_box {

using simulator::kNumAxes;

CaseRun::CaseRun(ClimbBox& box, const DrillRow& row, int target, std::uint64_t seed)
    : box_(box),
      row_(row),
      target_(target),
      rng_(seed),
      before_(situation_of(box)),
      reason_before_(box.report().output.reason),
      truth_before_(box.plant().truth()),
      num_violations_before_(box.monitor().num_violations()),
      report_(box.report()),
      truth_(truth_before_),
      now_us_(box.now_us()) {
  const int leg = target % 2 == 0 ? moving_leg() : stance_leg();
  axis_ = simulator::axis_of(leg, static_cast<int>(rng_.below(simulator::kJointsPerLeg)));
  // Somewhere between two cycles.
  inject_at_us_ = now_us_ + 1'000 * (1 + rng_.below(10));
  heard_us_.fill(-1);
  for (int i = 0; i < kNumAxes; ++i) {
    axes_[static_cast<std::size_t>(i)].measured =
        box.plant().drive(i).counts(truth_.joint_rad[static_cast<std::size_t>(i)]);
  }
}

CaseResult CaseRun::run(BoxWatcher* instead) {
  box_.watch(instead != nullptr ? instead : this);
  while (now_us_ < inject_at_us_ + row_.watch_us) box_.cycle();
  box_.watch(nullptr);
  result_.visible = visible_us_ >= 0;
  if (reacted_us_ >= 0) result_.reaction_us = std::max<std::int64_t>(0, reacted_us_ - visible_us_);
  if (result_.visible && reacted_us_ < 0) {
    fail(std::string("no reaction; ends in ") + climb::name(state()) + ", reason " +
         climb::name(reason()));
  } else if (result_.visible && result_.reaction_us > row_.bound_us) {
    fail("late: " + std::to_string(result_.reaction_us) + " us");
  }
  if (box_.monitor().num_violations() > num_violations_before_) {
    const auto& all = box_.monitor().violations();
    const auto index = static_cast<std::size_t>(num_violations_before_);
    fail(index < all.size() ? describe(all[index]) : "a violated invariant");
  }
  result_.met = result_.why[0] == '\0';
  return result_;
}

void CaseRun::fail(const std::string& why) {
  if (result_.why[0] != '\0') return;
  std::strncpy(result_.why.data(), why.c_str(), result_.why.size() - 1);
}

void CaseRun::before(std::int64_t now_us) {
  now_us_ = now_us;
  if (injected_us_ < 0 && now_us >= inject_at_us_) {
    injected_us_ = now_us;
    if (row_.inject != nullptr) row_.inject(*this);
  } else if (injected_us_ >= 0 && row_.go_on != nullptr) {
    row_.go_on(*this);
  }
}

void CaseRun::on_frame(const simulator::CarriedFrame& carried) {
  const simulator::BusFrame& frame = carried.frame;
  const std::uint32_t function = frame.id & 0x780U;
  const std::uint32_t node = frame.id & 0x7FU;
  if (carried.port == box_.master_port()) {
    last_master_frame_us_ = carried.time_us;
  } else if (simulator::is_standard(frame)) {
    heard_us_[frame.id] = carried.time_us;
  }
  if (node < 1 || node > kNumAxes) return;
  AxisWatch& axis = axes_[node - 1];
  if (function == 0x180 && frame.length >= 6) {
    axis.measured = simulator::signed_number(simulator::number_at(frame, 2, 4), 4);
  }
  if (function != 0x200 || carried.port != box_.master_port() || frame.length < 6) return;
  axis.control_word = static_cast<std::uint16_t>(simulator::number_at(frame, 0, 2));
  const std::int32_t target = simulator::signed_number(simulator::number_at(frame, 2, 4), 4);
  const bool follows = std::abs(target - axis.measured) <= 2;
  if (std::abs(target - axis.target) > 1 && !follows) axis.moved_us = carried.time_us;
  axis.target = target;
  axis.told_us = carried.time_us;
  if ((axis.control_word & 0x0F) == 0x0F) axis.enabled_us = carried.time_us;
  if ((axis.control_word & 0x0F) == 0x0B) axis.quick_stop_us = carried.time_us;
}

void CaseRun::on_truth(const simulator::PlantTruth& truth) {
  truth_ = truth;
  if (injected_us_ < 0) {
    truth_before_ = truth;
    return;
  }
  judge();
}

void CaseRun::on_report(const climb_controller::CycleReport& report) {
  report_ = report;
  if (injected_us_ >= 0) judge();
}

void CaseRun::judge() {
  if (visible_us_ < 0) {
    visible_us_ = row_.visible_at == nullptr ? injected_us_ : row_.visible_at(*this);
  }
  if (visible_us_ >= 0 && reacted_us_ < 0 && row_.has_reacted(*this)) reacted_us_ = now_us_;
  if (row_.harm == nullptr) return;
  if (const char* words = row_.harm(*this)) fail(words);
}

}  // namespace robot_in_a_box
