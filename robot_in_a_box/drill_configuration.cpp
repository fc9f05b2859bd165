// SPDX-License-Identifier: BSD-3-Clause
#include "robot_in_a_box/drill_configuration.h"

#include <array>

namespace robot_in_a_box {
namespace {

constexpr std::int64_t kBound_us = 5'000'000;

struct Lack {
  const char* name;
  std::uint16_t object;  ///< that must be named
  void (*take_away)(simulator::DriveObjects& objects);
};

constexpr std::array<Lack, 3> kLacks = {{
    {"no 6007h", 0x6007,
     [](simulator::DriveObjects& objects) { objects.abort_connection_option = false; }},
    {"no 6072h", 0x6072, [](simulator::DriveObjects& objects) { objects.max_torque = false; }},
    {"no 6077h", 0x6077, [](simulator::DriveObjects& objects) { objects.torque_actual = false; }},
}};

struct Refusal {
  std::int64_t named_us = -1;
  bool armed = false;
};

Refusal try_to_arm(int axis, const Lack& lack) {
  ClimbBoxParams params = tour_params(TourKind::kClimb, 1);
  lack.take_away(params.plant.drives[static_cast<std::size_t>(axis)].objects);
  ClimbBox box(params);
  Refusal refusal;
  while (box.now_us() < 2 * kBound_us) {
    if (box.now_us() % 500'000 == 0) box.order(climb::Order::kArm);
    box.cycle();
    if (box.monitor().num_targets() > 0) refusal.armed = true;
    for (const can::ObjectIssue& issue : box.report().issues) {
      const bool named = issue.axis == axis && issue.index == lack.object;
      if (named && refusal.named_us < 0) refusal.named_us = box.now_us();
    }
  }
  return refusal;
}

}  // namespace

const DrillRow& configuration_row() {
  static const DrillRow row = [] {
    DrillRow told;
    told.number = 29;
    told.fault = "object missing";
    told.injected = "one drive lacks 6007h, 6072h, 6077h";
    told.reaction = "not armed, the object is named";
    told.bound_us = kBound_us;
    return told;
  }();
  return row;
}

RowScore drill_configuration(const DrillRow& row) {
  RowScore score;
  score.row = &row;
  for (const Lack& lack : kLacks) {
    for (int axis = 0; axis < simulator::kNumAxes; ++axis) {
      const Refusal refusal = try_to_arm(axis, lack);
      ++score.cases;
      score.worst_us = std::max(score.worst_us, refusal.named_us);
      const bool is_named = refusal.named_us >= 0 && refusal.named_us <= kBound_us;
      if (is_named && !refusal.armed) continue;
      ++score.missed;
      score.misses.push_back(std::string(lack.name) + ", axis " + std::to_string(axis) +
                             (refusal.armed ? ": enabled" : ": not named in time"));
    }
  }
  return score;
}

}  // namespace robot_in_a_box
